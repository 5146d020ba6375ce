// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geom/strands.h"
#include "render/accel/accel.h"
#include "render/accel/embree_api.h"
#include "render/scene/render_params.h"

namespace pelage {

/// Data passed by Embree to a filter about one candidate of one ray (N is 1).
class EmbreeReport {
 public:
  explicit EmbreeReport(const RTCFilterFunctionNArguments* arguments) : arguments_(arguments) {}

  /// The query that uses the filter.
  template <class Query>
  Query& query() const {
    return static_cast<Query&>(*reinterpret_cast<EmbreeQuery*>(arguments_->context));
  }
  uint32_t geometry() const { return RTCHitN_geomID(arguments_->hit, 1, 0); }
  uint32_t primitive() const { return RTCHitN_primID(arguments_->hit, 1, 0); }
  float distance() const { return RTCRayN_tfar(arguments_->ray, 1, 0); }
  float u() const { return RTCHitN_u(arguments_->hit, 1, 0); }
  /// Whether the surface faces away from the ray's origin: where a ray leaves a round strand.
  bool faces_away() const {
    return RTCHitN_Ng_x(arguments_->hit, 1, 0) * RTCRayN_dir_x(arguments_->ray, 1, 0) +
               RTCHitN_Ng_y(arguments_->hit, 1, 0) * RTCRayN_dir_y(arguments_->ray, 1, 0) +
               RTCHitN_Ng_z(arguments_->hit, 1, 0) * RTCRayN_dir_z(arguments_->ray, 1, 0) >
           0;
  }
  void reject() const { arguments_->valid[0] = 0; }
  /// Call for a candidate that is kept: the ray then ends there instead of at the candidate.
  void set_ray_end(float far) const { RTCRayN_tfar(arguments_->ray, 1, 0) = far; }

 private:
  const RTCFilterFunctionNArguments* arguments_;
};

/// Far end for a ray that hit something at `distance`, chosen so that reports of other segments do not depend
/// on it (law 1). Embree searches round curves piecewise, only in front of the ray's far end, and the result
/// changes slightly when that lies within the segment. `longest`: diagonal of the largest box of a segment;
/// no segment that is hit before `distance` extends farther than this.
inline float far_behind(float distance, float longest) {
  return longest > 0 ? distance * (1 + 0x1p-20f) + longest : distance;
}
/// `longest` for far_behind(): 0 for flat curves, whose pieces are all tested.
float longest_segment(const Strands& strands, CurveShape shape);

/// Whether all numbers of a ray that must be finite are.
bool is_finite(const Ray& ray);
/// For flat curves, Embree ignores hits within a strand's width of the origin, on any strand. Its rays may
/// therefore start `before` the given ones, by at least a width; distances increase accordingly.
RTCRay embree_ray(const Ray& ray, float before = 0);
/// How far before its origin a ray starts for strands no wider than `widest`; 0 for round ones.
inline float begins_before(float widest, CurveShape shape) {
  return shape == CurveShape::kFlat ? 1.25f * widest : 0.0f;
}
/// Whether a hit on the ray's own strand, the only one of its batch, is a self-intersection near the start:
/// within two widths both along the ray and along the strand. The same rule as in the fur tree.
bool is_start(const Strands& strand, const Ray& ray, uint32_t segment, float u, float distance);
/// Embree geometry type for curves of a basis.
RTCGeometryType embree_curve_type(CurveBasis basis, CurveShape shape);

/// Index of the nearer joint: 1 when `u` is closer to the segment's end. Pieces of a segment overlap where
/// they meet, so that a point on the border of two may be reported twice; therefore the border between the
/// joints runs through the middle of one of the `tessellation_rate` pieces of a flat segment.
inline uint32_t joint_beside(float u, int tessellation_rate) {
  return u > 0.5f + 0.5f / static_cast<float>(tessellation_rate) ? 1 : 0;
}

/// h of a hit on `strand`, the only one of its batch, when v does not provide it: from the surface normal of
/// a round curve or, where Embree provides none (flat linear segments), from the position of the hit beside
/// the axis.
float offset_across(const Strands& strand, bool round, const Ray& ray, const Hit& hit, const V3f& normal);

}  // namespace pelage
