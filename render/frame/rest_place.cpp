// SPDX-License-Identifier: Apache-2.0
#include "render/frame/rest_place.h"

#include "geom/rest_position.h"
#include "render/frame/skin_point.h"

namespace pelage {
namespace {

V3f normal_of(const SurfacePoint& at) {
  return at.smooth_normal.length2() > 0 ? at.smooth_normal : at.du.cross(at.dv);
}

/// Size of a posed face relative to its size at rest, from the triangle that was hit.
float scale_of(const SkinMesh& triangle, const SurfacePoint& rest) {
  if (triangle.vertex_uv.size() < 3) return 1;
  const V2f* at = triangle.vertex_uv.data();
  const V2f e1 = at[1] - at[0], e2 = at[2] - at[0];
  const V3f &a = triangle.position(0), &b = triangle.position(1), &c = triangle.position(2);
  const float posed = (b - a).cross(c - a).length();
  const float at_rest = rest.du.cross(rest.dv).length() * std::abs(e1.x * e2.y - e1.y * e2.x);
  return posed > 0 && at_rest > 0 ? std::sqrt(posed / at_rest) : 1;
}

}  // namespace

RestPlace rest_place(const FurPart& part, const Strands& strand) {
  if (!part.rest || !strand.has_roots()) {
    return {rest_position(strand, 0).value_or(strand.point(0)),
            strand.strand_points(0) > 1 ? strand.point(1) - strand.point(0) : V3f(0), 1};
  }
  const RootAddress& root = strand.root(0);
  const SurfacePoint at = part.rest->evaluate(root.face, root.u, root.v);
  return {at.position, normal_of(at), part.scale};
}

RestPlace rest_place(const SkinPart& part, const Ray& ray, const Hit& hit, const SkinMesh& triangle) {
  if (!part.rest) {
    const SkinPoint point = skin_point(triangle, ray, hit);
    return {point.position - ray.time * point.shutter_motion, point.normal, 1};
  }
  const V2f place = skin_parameters(triangle, hit);
  const SurfacePoint at = part.rest->evaluate(triangle.faces[0], place.x, place.y);
  return {at.position, normal_of(at), scale_of(triangle, at)};
}

}  // namespace pelage
