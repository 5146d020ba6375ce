// SPDX-License-Identifier: Apache-2.0
#include "groom/sim/skin_moment.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/closest_point.h"
#include "geom/tessellation.h"
#include "geom/triangle_distance.h"

namespace pelage {
namespace {

Triangle triangle_of(const SkinMesh& mesh, uint32_t triangle) {
  const auto corner = [&](size_t i) { return V3d(mesh.position(mesh.triangles[3 * size_t(triangle) + i])); };
  return {corner(0), corner(1), corner(2)};
}

double distance_to(const Box3f& box, const V3d& point) {
  V3d outside(0);
  for (int k = 0; k < 3; ++k) outside[k] = std::max({box.min[k] - point[k], point[k] - box.max[k], 0.0});
  return outside.length();
}

std::optional<SkinPlace> nearest_place(const ClosestPointTree& skin, double unit, const V3d& point,
                                       double limit, uint32_t& triangle) {
  ClosestPoint closest;
  if (!skin.closest(V3f(point / unit), static_cast<float>(limit / unit), closest)) return {};
  SkinPlace place;
  place.position = V3d(closest.position) * unit;
  V3d away = point - place.position;
  if (closest.inside) away = -away;
  const double distance = away.length();
  // Rounding of positions hides the direction of very short distances.
  const bool is_clear = distance > 1e-5 * unit;
  place.outward = is_clear ? away / distance : V3d(closest.normal);
  place.height = closest.inside ? -distance : distance;
  triangle = closest.triangle;
  return place;
}

}  // namespace

std::optional<SkinPlace> nearest_place(const ClosestPointTree& skin, double meters_per_unit, const V3d& point,
                                       double limit) {
  uint32_t triangle = 0;
  return nearest_place(skin, meters_per_unit, point, limit, triangle);
}

CarriedPlane plane_of_others(const SkinMoment& at, const NodeMove& node, const RodRoot& root) {
  const double unit = at.meters_per_unit;
  CarriedPlane nearest;
  double least = std::numeric_limits<double>::infinity();
  for (const OtherSkin& other : at.others) {
    const double limit = node.reach + (node.after - node.before).length() + other.motion * unit;
    if (distance_to(other.box_before, node.before / unit) * unit > limit) continue;
    uint32_t t = 0;
    const auto place = nearest_place(*other.before, unit, node.before, limit, t);
    if (!place) continue;
    const Triangle from = triangle_of(*other.mesh_before, t), to = triangle_of(*other.mesh, t);
    const V3d weights = nearest_on_triangle(from, place->position / unit).weights;
    const V3d was = from.normal(), is = to.normal();
    if (was == V3d(0) || is == V3d(0)) continue;
    const V3d position =
        (to.corner[0] * weights.x + to.corner[1] * weights.y + to.corner[2] * weights.z) * unit;
    const V3d outward = turned(smallest_turn(was, is), place->outward);
    const double gap = outward.dot(node.after - position);
    if (gap >= least) continue;
    least = gap;
    const Imath::Quatd to_root = ~root.frame;
    nearest.normal = turned(to_root, outward);
    nearest.point = turned(to_root, position + outward * node.clearance - root.position);
  }
  return nearest;
}

V3d way_out_of_others(const SkinMoment& at, const V3d& point, double clearance, double limit) {
  V3d way(0);
  for (const OtherSkin& other : at.others) {
    if (distance_to(other.box, (point + way) / at.meters_per_unit) * at.meters_per_unit >= clearance)
      continue;
    const auto place = nearest_place(*other.now, at.meters_per_unit, point + way, limit);
    if (place && place->height < clearance) way += place->outward * (clearance - place->height);
  }
  return way;
}

}  // namespace pelage
