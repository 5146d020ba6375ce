// SPDX-License-Identifier: Apache-2.0
#include "image/map_projection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pelage {
namespace {

/// The axes of the image that looks along `axis`: as seen from its positive end, y (or -z) up.
struct PlaneAxes {
  int u, v;
  float u_sign, v_sign;
};
constexpr PlaneAxes kPlanes[] = {{2, 1, -1, 1}, {0, 2, 1, -1}, {0, 1, 1, 1}};

}  // namespace

size_t Projector::lookups(const FieldPoint& point, std::array<MapLookup, 3>& out) const {
  const V3f at = point.rest - center_;
  switch (kind_) {
    case MapProjection::kTexture:
      out[0] = {point.u, point.v, 1};
      return 1;
    case MapProjection::kFace:
      out[0] = {point.face_uv.x, point.face_uv.y, 1};
      return 1;
    case MapProjection::kPlanar:
      out[0] = planar(at, axis_);
      return 1;
    case MapProjection::kCylinder:
    case MapProjection::kSphere:
      out[0] = around(at);
      return 1;
    case MapProjection::kTriplanar:
      break;
  }
  // The fourth power keeps the transitions between the three images short.
  float sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float n2 = point.normal[axis] * point.normal[axis];
    MapLookup& lookup = out[static_cast<size_t>(axis)];
    lookup = planar(at, axis);
    lookup.weight = n2 * n2;
    sum += lookup.weight;
  }
  if (!(sum > 0)) {  // strands without a skin have no normals
    out[0] = planar(at, axis_);
    return 1;
  }
  for (MapLookup& lookup : out) lookup.weight /= sum;
  return 3;
}

MapLookup Projector::planar(const V3f& at, int axis) const {
  const PlaneAxes& plane = kPlanes[axis];
  return {0.5f + plane.u_sign * at[plane.u] / size_[plane.u],
          0.5f + plane.v_sign * at[plane.v] / size_[plane.v], 1};
}

/// u is the angle around the axis, with u = 0.5 at the plane's front. v runs along the axis, in equal steps
/// of distance (cylinder) or of latitude (sphere).
MapLookup Projector::around(const V3f& at) const {
  const int front = (axis_ + 1) % 3, side = (axis_ + 2) % 3;
  const float turn = std::atan2(at[side], at[front]);
  const float u = 0.5f + turn * (0.5f / std::numbers::pi_v<float>);
  if (kind_ == MapProjection::kCylinder) return {u, 0.5f + at[axis_] / size_[axis_], 1};
  const float length = at.length();
  const float sine = length > 0 ? std::clamp(at[axis_] / length, -1.0f, 1.0f) : 0.0f;
  return {u, 0.5f + std::asin(sine) / std::numbers::pi_v<float>, 1};
}

}  // namespace pelage
