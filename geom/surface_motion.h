// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "geom/limit_surface.h"

namespace pelage {

/// Returns the point (u, v) of a ptex face on the cage itself rather than on its limit surface, with
/// derivatives: interpolated between the corners, linearly on triangles and bilinearly on squares.
/// `position(vertex)`: of a control vertex.
SurfacePoint cage_point(const SurfaceTopology& topology, uint32_t face, float u, float v,
                        const std::function<V3f(uint32_t)>& position);

/// How a surface moves between two times, near one of its points. In a rigid motion, all results are exact up
/// to rounding, however far the surface is from these two points.
struct SurfaceStep {
  SurfacePoint now, next;

  /// Returns where a point on the surface is at the later time.
  V3f moved(const V3f& point) const;
  /// Returns where a point of a strand is at the later time. The strand turns with the surface, but does not
  /// stretch. `root`: root of the strand at the earlier time.
  V3f moved(const V3f& point, const V3f& root) const;
};

}  // namespace pelage
