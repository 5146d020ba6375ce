// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "geom/tessellation.h"

namespace pelage {

/// Returns whether a mesh has no boundary: each directed edge is used as often as its opposite. Vertices that
/// have the same position at every motion key count as one, because meshes are often split along the seams
/// of their texture coordinates.
bool is_closed(const SkinMesh& mesh);

/// Winding numbers of a closed mesh at one motion key: how often the surface encloses a point. Every path
/// from a point whose number is not 0 to a point whose number is 0 crosses the surface, also where the
/// surface intersects itself. The number is 0 outside the bounding box.
///
/// Counts the signed crossings of the upward ray from the point. A ray through an edge or a vertex crosses
/// exactly one of the triangles around it. `mesh` must outlive this object. Thread safety: const members may
/// be called from any thread.
class WindingNumbers {
 public:
  WindingNumbers(const SkinMesh& mesh, int key);

  /// Returns the winding number at a point. Exact if the distance from the point to the surface is larger
  /// than the rounding errors of positions.
  int at(const V3f& point) const;
  size_t bytes() const { return (first_.capacity() + triangles_.capacity()) * sizeof(uint32_t); }

 private:
  struct Range {
    int begin, end;
  };
  Range columns(float low, float high, int axis) const;

  const SkinMesh& mesh_;
  int key_;
  // A grid of columns along z. The triangles over column (x, y) are triangles_[first_[i]] ... with
  // i = y * side_ + x.
  int side_ = 1;
  V2f origin_{0}, scale_{0};
  std::vector<uint32_t> first_, triangles_;
};

}  // namespace pelage
