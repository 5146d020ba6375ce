// SPDX-License-Identifier: Apache-2.0
#include "render/accel/embree_query.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geom/curve.h"
#include "geom/curve_bounds.h"

namespace pelage {

float longest_segment(const Strands& strands, CurveShape shape) {
  float longest = 0;
  if (shape == CurveShape::kFlat) return longest;
  std::vector<Box3f> hulls;
  for (int key = 0; key < strands.motion_keys(); ++key) {
    for (size_t strand = 0; strand < strands.strand_count(); ++strand) {
      hulls.clear();
      append_hull_bounds(strands, strand, key, hulls);
      for (const Box3f& hull : hulls) longest = std::max(longest, hull.size().length());
    }
  }
  return longest;
}

bool is_finite(const Ray& ray) {
  const float sum = ray.origin.x + ray.origin.y + ray.origin.z + ray.direction.x + ray.direction.y +
                    ray.direction.z + ray.near + ray.time;
  return std::isfinite(sum) && !std::isnan(ray.far);
}

RTCRay embree_ray(const Ray& ray, float before) {
  const V3f origin = ray.origin - before * ray.direction;
  RTCRay r;
  r.org_x = origin.x;
  r.org_y = origin.y;
  r.org_z = origin.z;
  r.tnear = ray.near + before;
  r.dir_x = ray.direction.x;
  r.dir_y = ray.direction.y;
  r.dir_z = ray.direction.z;
  r.time = ray.time;
  r.tfar = ray.far + before;
  r.mask = ~0u;
  r.id = 0;
  r.flags = 0;
  return r;
}

bool is_start(const Strands& strand, const Ray& ray, uint32_t segment, float u, float distance) {
  const CubicSegment curve = bezier_segment_at(strand, 0, segment, ray.time);
  const float twice = 4 * curve_radius(curve, u);
  if (!(distance < twice)) return false;
  const float between = static_cast<float>(segment) + u - ray.start.place;
  return std::abs(between) * curve_tangent(curve, u).length() < twice;
}

RTCGeometryType embree_curve_type(CurveBasis basis, CurveShape shape) {
  const bool flat = shape == CurveShape::kFlat;
  switch (basis) {
    case CurveBasis::kLinear:
      return flat ? RTC_GEOMETRY_TYPE_FLAT_LINEAR_CURVE : RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE;
    case CurveBasis::kCatmullRom:
      return flat ? RTC_GEOMETRY_TYPE_FLAT_CATMULL_ROM_CURVE : RTC_GEOMETRY_TYPE_ROUND_CATMULL_ROM_CURVE;
    case CurveBasis::kBezier:
      return flat ? RTC_GEOMETRY_TYPE_FLAT_BEZIER_CURVE : RTC_GEOMETRY_TYPE_ROUND_BEZIER_CURVE;
    case CurveBasis::kPinnedBSpline:
    case CurveBasis::kBSpline:
      break;
  }
  return flat ? RTC_GEOMETRY_TYPE_FLAT_BSPLINE_CURVE : RTC_GEOMETRY_TYPE_ROUND_BSPLINE_CURVE;
}

float offset_across(const Strands& strand, bool round, const Ray& ray, const Hit& hit, const V3f& normal) {
  const CubicSegment segment = bezier_segment_at(strand, 0, hit.segment, ray.time);
  const V3f tangent = curve_tangent(segment, hit.u).normalized();
  const V3f ez = tangent.cross(-ray.direction).normalized();
  float h = 0;
  if (round) {
    h = -(normal - normal.dot(tangent) * tangent).normalized().dot(ez);
  } else {
    const float radius = curve_radius(segment, hit.u);
    const V3f beside = ray.origin + hit.distance * ray.direction - curve_position(segment, hit.u);
    h = radius > 0 ? -beside.dot(ez) / radius : 0;
  }
  return std::clamp(h, -1.0f, 1.0f);
}

}  // namespace pelage
