// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geom/tessellation.h"
#include "render/accel/accel.h"

namespace pelage {

/// A hit on a skin's triangle, evaluated at the time of the ray.
struct SkinPoint {
  V3f position{0};
  V3f normal{0};  ///< unit, interpolated from the limit surface; faces the origin of the ray
  /// Origin of rays that leave the surface. It lies on the curved surface that the triangle approximates, so
  /// that facets of a convex skin do not shadow the skin itself at grazing light [Hanika21].
  V3f start{0};
  V3f shutter_motion{0};  ///< displacement of the point while the shutter is open
};

/// Evaluates a hit of a ray on a skin. `triangle`: HitGeometry::triangle of the hit.
SkinPoint skin_point(const SkinMesh& triangle, const Ray& ray, const Hit& hit);

/// Returns the height of the skin above the tangent plane at a hit, at the offset `away` from the hit along
/// that plane. The height is extrapolated from the curvature of this triangle, and clamped to +- the length
/// of `away`. `normal`: SkinPoint::normal.
float skin_rise(const SkinMesh& triangle, float time, const V3f& normal, const V3f& away);

/// Returns the parameters (u, v) of a hit in its ptex face.
V2f skin_parameters(const SkinMesh& triangle, const Hit& hit);

}  // namespace pelage
