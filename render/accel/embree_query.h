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
  /// Whether the surface faces away from the ray's origin, as it does where a ray leaves a round strand.
  bool faces_away() const {
    return RTCHitN_Ng_x(arguments_->hit, 1, 0) * RTCRayN_dir_x(arguments_->ray, 1, 0) +
               RTCHitN_Ng_y(arguments_->hit, 1, 0) * RTCRayN_dir_y(arguments_->ray, 1, 0) +
               RTCHitN_Ng_z(arguments_->hit, 1, 0) * RTCRayN_dir_z(arguments_->ray, 1, 0) >
           0;
  }
  void reject() const { arguments_->valid[0] = 0; }
  /// Ends the ray at `far` instead of at the candidate. Call this for a candidate that is kept.
  void set_ray_end(float far) const { RTCRayN_tfar(arguments_->ray, 1, 0) = far; }

 private:
  const RTCFilterFunctionNArguments* arguments_;
};

/// New far end for a ray that hit something at `distance`. Embree searches round curves piece by piece and
/// only in front of the far end, so the result for a segment changes slightly when the far end lies within
/// that segment. The returned far end is behind every segment that can still be hit before `distance`, so the
/// results for these segments do not depend on it (law 1). `longest`: diagonal of the largest box of a
/// segment.
inline float far_behind(float distance, float longest) {
  return longest > 0 ? distance * (1 + 0x1p-20f) + longest : distance;
}
/// `longest` for far_behind(): 0 for flat curves, whose pieces are all tested.
float longest_segment(const Strands& strands, CurveShape shape);

/// Whether all numbers of the ray that must be finite are finite.
bool is_finite(const Ray& ray);
/// For flat curves, Embree ignores hits within a strand's width of the origin, on any strand. Embree's ray
/// may therefore start earlier than the given ray, by the distance `before`, which is at least one width. All
/// distances then increase by `before`.
RTCRay embree_ray(const Ray& ray, float before = 0);
/// `before` of embree_ray() for strands of at most the width `widest`; 0 for round strands.
inline float begins_before(float widest, CurveShape shape) {
  return shape == CurveShape::kFlat ? 1.25f * widest : 0.0f;
}
/// Whether a hit on the strand that the ray starts on is a self-intersection: within two widths of the start,
/// both along the ray and along the strand. The fur tree has the same rule. `strand`: a batch of only this
/// strand.
bool is_start(const Strands& strand, const Ray& ray, uint32_t segment, float u, float distance);
/// Embree geometry type for curves of a basis.
RTCGeometryType embree_curve_type(CurveBasis basis, CurveShape shape);

/// Index of the nearer joint: 1 when `u` is closer to the segment's end. Embree tests a flat segment as
/// `tessellation_rate` pieces. Adjacent pieces overlap, so a point between two pieces may be reported twice.
/// The value of `u` that separates the two joints is therefore in the middle of a piece.
inline uint32_t joint_beside(float u, int tessellation_rate) {
  return u > 0.5f + 0.5f / static_cast<float>(tessellation_rate) ? 1 : 0;
}

/// h of a hit whose v is not h. For a round curve, h comes from the surface normal. For flat linear segments,
/// for which Embree provides no normal, h comes from the distance between the hit and the axis. `strand`: a
/// batch of only the strand that was hit.
float offset_across(const Strands& strand, bool round, const Ray& ray, const Hit& hit, const V3f& normal);

}  // namespace pelage
