// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geom/strands.h"
#include "render/accel/accel.h"
#include "render/accel/embree_api.h"
#include "render/scene/render_params.h"

namespace pelage {

/// The data that Embree passes to a filter function: one candidate hit of one ray (N is 1).
class EmbreeReport {
 public:
  explicit EmbreeReport(const RTCFilterFunctionNArguments* arguments) : arguments_(arguments) {}

  /// Returns the query whose filter function was called. `Query` must be the query's type.
  template <class Query>
  Query& query() const {
    return static_cast<Query&>(*reinterpret_cast<EmbreeQuery*>(arguments_->context));
  }
  uint32_t geometry() const { return RTCHitN_geomID(arguments_->hit, 1, 0); }
  uint32_t primitive() const { return RTCHitN_primID(arguments_->hit, 1, 0); }
  float distance() const { return RTCRayN_tfar(arguments_->ray, 1, 0); }
  float u() const { return RTCHitN_u(arguments_->hit, 1, 0); }
  float v() const { return RTCHitN_v(arguments_->hit, 1, 0); }
  V3f normal() const {
    return {RTCHitN_Ng_x(arguments_->hit, 1, 0), RTCHitN_Ng_y(arguments_->hit, 1, 0),
            RTCHitN_Ng_z(arguments_->hit, 1, 0)};
  }
  /// Whether the surface faces away from the ray's origin, as it does where a ray leaves a round strand.
  bool faces_away() const {
    return RTCHitN_Ng_x(arguments_->hit, 1, 0) * RTCRayN_dir_x(arguments_->ray, 1, 0) +
               RTCHitN_Ng_y(arguments_->hit, 1, 0) * RTCRayN_dir_y(arguments_->ray, 1, 0) +
               RTCHitN_Ng_z(arguments_->hit, 1, 0) * RTCRayN_dir_z(arguments_->ray, 1, 0) >
           0;
  }
  void reject() const { arguments_->valid[0] = 0; }
  /// Ends the ray at `far` instead of at the candidate. Call this only for a candidate that the filter does
  /// not reject.
  void set_ray_end(float far) const { RTCRayN_tfar(arguments_->ray, 1, 0) = far; }

 private:
  const RTCFilterFunctionNArguments* arguments_;
};

/// Returns the new far end for a ray that hit something at `distance`. Embree searches round curves piece by
/// piece and only in front of the far end, so the result for a segment changes slightly when the far end lies
/// within that segment. The returned far end is behind every segment that can still be hit before `distance`,
/// so the results for these segments do not depend on the far end (law 1). `longest`: diagonal of the largest
/// box of a segment; with 0, the far end is `distance`.
inline float far_behind(float distance, float longest) {
  return longest > 0 ? distance * (1 + 0x1p-20f) + longest : distance;
}
/// Returns `longest` for far_behind(). For flat curves it is 0, because Embree tests all pieces of a flat
/// curve.
float longest_segment(const Strands& strands, CurveShape shape);

/// Whether the ray's origin, direction, near end and time are finite and its far end is not NaN.
bool is_finite(const Ray& ray);
/// Converts a ray to Embree's form. Embree's ray starts earlier by the distance `before`, so all distances
/// that Embree reports are larger by `before`. Reason: Embree ignores every hit on a flat curve that is
/// nearer to the origin of the ray than the width of the strand, also on strands other than the one that the
/// ray starts on. For flat curves, `before` should therefore be at least one width (see begins_before()).
RTCRay embree_ray(const Ray& ray, float before = 0);
/// Returns `before` for embree_ray(), for strands whose widths are at most `widest`; 0 for round strands.
inline float begins_before(float widest, CurveShape shape) {
  return shape == CurveShape::kFlat ? 1.25f * widest : 0.0f;
}
/// Whether a hit on the strand that the ray starts on is a self-intersection: within two widths of the start,
/// both along the ray and along the strand. The fur tree has the same rule. `strand`: a batch of only this
/// strand.
bool is_start(const Strands& strand, const Ray& ray, uint32_t segment, float u, float distance);
/// Returns Embree's geometry type for curves of this basis and shape.
RTCGeometryType embree_curve_type(CurveBasis basis, CurveShape shape);

/// Number of straight pieces in which Embree tests a flat segment. The maximum is 16. Of the camera rays that
/// hit a ball of 100,000 strands, 5.9 % hit a different strand at rate 4 than at rate 16. At rate 8, 1.2 %
/// differ from rate 16; at rate 12, 0.4 %. Rates 4 and 8 cost the same (one AVX register); rate 16 makes
/// shadow rays 4 to 10 % slower.
inline constexpr int kTessellationRate = 8;

/// Returns which joint of a segment is nearer to the parameter `u`: 0 for the segment's beginning, 1 for its
/// end. Embree tests a flat segment as `tessellation_rate` pieces. Adjacent pieces overlap, so a point
/// between two pieces may be reported twice. Both reports of such a point must give the same joint. The value
/// of `u` at which the joint changes is therefore in the middle of a piece, not between two pieces.
inline uint32_t joint_beside(float u, int tessellation_rate) {
  return u > 0.5f + 0.5f / static_cast<float>(tessellation_rate) ? 1 : 0;
}

/// Returns h (Hit::v) for hits for which Embree's own v is not h. For a round curve, h comes from the surface
/// normal. For flat linear segments, for which Embree provides no normal, h comes from the distance between
/// the hit and the axis. `strand`: a batch of only the strand that was hit.
float offset_across(const Strands& strand, bool round, const Ray& ray, const Hit& hit, const V3f& normal);

}  // namespace pelage
