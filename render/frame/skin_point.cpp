// SPDX-License-Identifier: Apache-2.0
#include "render/frame/skin_point.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pelage {
namespace {

struct Corner {
  V3f position, normal;
};

Corner corner(const SkinMesh& mesh, uint32_t vertex, float time) {
  if (mesh.motion_keys == 1) return {mesh.position(vertex), mesh.normal(vertex)};
  const float scaled = std::clamp(time, 0.0f, 1.0f) * static_cast<float>(mesh.motion_keys - 1);
  const int key = std::min(static_cast<int>(scaled), mesh.motion_keys - 2);
  const float t = scaled - static_cast<float>(key);
  return {mesh.position(vertex, key) * (1 - t) + mesh.position(vertex, key + 1) * t,
          (mesh.normal(vertex, key) * (1 - t) + mesh.normal(vertex, key + 1) * t).normalized()};
}

}  // namespace

SkinPoint skin_point(const SkinMesh& triangle, const Ray& ray, const Hit& hit) {
  const float weights[3] = {1 - hit.u - hit.v, hit.u, hit.v};
  std::array<Corner, 3> corners;
  SkinPoint point;
  for (uint32_t c = 0; c < 3; ++c) {
    corners[c] = corner(triangle, c, ray.time);
    point.position += weights[c] * corners[c].position;
    point.normal += weights[c] * corners[c].normal;
    if (triangle.motion_keys > 1) {
      point.shutter_motion +=
          weights[c] * (triangle.position(c, triangle.motion_keys - 1) - triangle.position(c, 0));
    }
  }
  V3f facet = (corners[1].position - corners[0].position)
                  .cross(corners[2].position - corners[0].position)
                  .normalized();
  if (facet.dot(ray.direction) > 0) facet = -facet;
  point.normal.normalize();
  if (point.normal.dot(facet) < 0) point.normal = -point.normal;

  // The tangent planes of the corners determine how far the surface bulges out over the facet.
  V3f bulge(0);
  for (int c = 0; c < 3; ++c) {
    V3f n = corners[c].normal;
    if (n.dot(facet) < 0) n = -n;
    const float below = std::min(0.0f, (point.position - corners[c].position).dot(n));
    bulge -= weights[c] * below * n;
  }
  // The error of the hit is a few units in the last place of its largest coordinate and of its distance.
  const V3f& p = point.position;
  const float size = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), hit.distance});
  point.start = p + bulge + (0x1p-20f * size) * facet;
  return point;
}

float skin_rise(const SkinMesh& triangle, float time, const V3f& normal, const V3f& away) {
  const Corner a = corner(triangle, 0, time), b = corner(triangle, 1, time), c = corner(triangle, 2, time);
  // away = s (b - a) + t (c - a), by the dual basis of the triangle.
  const V3f u = b.position - a.position, v = c.position - a.position;
  const V3f across = u.cross(v);
  const float square = across.length2();
  if (!(square > 0)) return 0;
  const float s = away.cross(v).dot(across) / square, t = u.cross(away).dot(across) / square;
  V3f turned = s * (b.normal - a.normal) + t * (c.normal - a.normal);
  if (a.normal.dot(normal) < 0) turned = -turned;
  const float max = away.length();
  return std::clamp(-0.5f * turned.dot(away), -max, max);
}

V2f skin_parameters(const SkinMesh& triangle, const Hit& hit) {
  const V2f* corners = triangle.vertex_uv.data();
  return corners[0] * (1 - hit.u - hit.v) + corners[1] * hit.u + corners[2] * hit.v;
}

}  // namespace pelage
