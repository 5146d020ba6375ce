// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geom/strands.h"
#include "render/accel/accel.h"
#include "render/accel/embree_api.h"
#include "render/scene/render_params.h"

namespace pelage {

/// What Embree hands to a filter about one candidate of one ray (N is 1).
class EmbreeReport {
 public:
  explicit EmbreeReport(const RTCFilterFunctionNArguments* arguments) : arguments_(arguments) {}

  /// The query that the filter belongs to.
  template <class Query>
  Query& query() const {
    return static_cast<Query&>(*reinterpret_cast<EmbreeQuery*>(arguments_->context));
  }
  uint32_t geometry() const { return RTCHitN_geomID(arguments_->hit, 1, 0); }
  uint32_t primitive() const { return RTCHitN_primID(arguments_->hit, 1, 0); }
  float distance() const { return RTCRayN_tfar(arguments_->ray, 1, 0); }
  float u() const { return RTCHitN_u(arguments_->hit, 1, 0); }
  /// Whether the surface looks away from the ray's origin: where a ray leaves a round strand.
  bool faces_away() const {
    return RTCHitN_Ng_x(arguments_->hit, 1, 0) * RTCRayN_dir_x(arguments_->ray, 1, 0) +
               RTCHitN_Ng_y(arguments_->hit, 1, 0) * RTCRayN_dir_y(arguments_->ray, 1, 0) +
               RTCHitN_Ng_z(arguments_->hit, 1, 0) * RTCRayN_dir_z(arguments_->ray, 1, 0) >
           0;
  }
  void reject() const { arguments_->valid[0] = 0; }
  /// To be said of a candidate that is kept: from now on the ray ends there instead of at the candidate.
  void set_ray_end(float far) const { RTCRayN_tfar(arguments_->ray, 1, 0) = far; }

 private:
  const RTCFilterFunctionNArguments* arguments_;
};

/// Where a ray may end that has met something at `distance`, so that what it is told of other segments does
/// not depend on that (law 1). Embree looks for round curves piece by piece, only in front of the ray's far
/// end, and what it finds changes a little when that lies within the segment. `longest` is the diagonal of
/// the largest box of a segment: no segment that is met before `distance` reaches further than this.
inline float far_behind(float distance, float longest) {
  return longest > 0 ? distance * (1 + 0x1p-20f) + longest : distance;
}
/// `longest` of far_behind(): 0 for flat curves, whose pieces are all looked at.
float longest_segment(const Strands& strands, CurveShape shape);

/// Whether every number of a ray that must be finite is.
bool is_finite(const Ray& ray);
/// Of flat curves Embree drops what a ray meets within a strand's width of its origin, whatever strand that
/// is. So its rays may begin `before` theirs, at least a width: distances are larger by so much there.
RTCRay embree_ray(const Ray& ray, float before = 0);
/// How far before its origin a ray begins at strands that are no wider than `widest`: round ones need none.
inline float begins_before(float widest, CurveShape shape) {
  return shape == CurveShape::kFlat ? 1.25f * widest : 0.0f;
}
/// Whether a hit on the strand that a ray starts on, the only one of its batch, is but that strand near the
/// start: within two widths both along the ray and along the strand. As the fur tree has it.
bool is_start(const Strands& strand, const Ray& ray, uint32_t segment, float u, float distance);
/// The kind of Embree geometry that curves of a basis are.
RTCGeometryType embree_curve_type(CurveBasis basis, CurveShape shape);

/// Pieces of a segment overlap where they meet, so that a place on the border of two may be reported twice;
/// so the border between two joints runs through the middle of one of the `tessellation_rate` pieces of a
/// flat segment. 1 when `u` lies beyond it, nearer to the segment's end.
inline uint32_t joint_beside(float u, int tessellation_rate) {
  return u > 0.5f + 0.5f / static_cast<float>(tessellation_rate) ? 1 : 0;
}

/// h of a hit on `strand`, the only one of its batch, whose v does not say it: from the surface normal of a
/// round curve, or, where Embree gives none (flat linear segments), from the place of the hit beside the
/// axis.
float offset_across(const Strands& strand, bool round, const Ray& ray, const Hit& hit, const V3f& normal);

}  // namespace pelage
