// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "base/vector.h"
#include "geom/limit_surface.h"

namespace pelage {

/// Values at the vertices of a cage, interpolated over its faces as texture coordinates are. Immutable.
/// Thread safety: const members may be called from any thread.
class CageValues {
 public:
  /// `values`: one per control vertex.
  CageValues(std::shared_ptr<const SurfaceTopology> topology, std::vector<Rgb> values);
  /// Returns the value at (u, v) of a ptex face.
  Rgb at(uint32_t face, float u, float v) const;
  size_t bytes() const { return values_.capacity() * sizeof(Rgb); }

 private:
  std::shared_ptr<const SurfaceTopology> topology_;
  std::vector<Rgb> values_;
};

/// Returns the mean curvature at each control vertex of a surface, in 1 / unit: > 0 where it is convex, 0 at
/// vertices without faces. It is measured along the edges of the cage, between the points of the surface at
/// their ends, so it describes the surface at the scale of these edges.
std::vector<float> vertex_curvatures(const LimitSurface& surface);

}  // namespace pelage
