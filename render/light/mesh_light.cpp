// SPDX-License-Identifier: Apache-2.0
#include "render/light/mesh_light.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "render/sampling/warp.h"

namespace pelage {
namespace {

constexpr uint32_t kLeaf = 4;  // max count of triangles of a leaf
/// Relative difference of distances below which two points are the same.
constexpr float kSame = 1e-4f;

V3f twice_area(const MeshLight::Triangle& t) {
  return (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]);
}

/// Distance at which a ray crosses a triangle, from either side; infinity if it misses [Moeller97].
float cross(const MeshLight::Triangle& t, const V3f& from, const V3f& direction) {
  constexpr float kMiss = std::numeric_limits<float>::infinity();
  const V3f a = t.corners[1] - t.corners[0], b = t.corners[2] - t.corners[0], p = direction.cross(b);
  const float determinant = a.dot(p);
  if (determinant == 0) return kMiss;
  const V3f to = from - t.corners[0], q = to.cross(a);
  const float u = to.dot(p) / determinant, v = direction.dot(q) / determinant;
  const float distance = b.dot(q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && distance > 0 ? distance : kMiss;
}

bool meets(const Box3f& box, const V3f& from, const V3f& inverse, float far) {
  float enter = 0, leave = far;
  for (int i = 0; i < 3; ++i) {
    const float a = (box.min[i] - from[i]) * inverse[i], b = (box.max[i] - from[i]) * inverse[i];
    // Comparisons with NaN, of a ray inside a side of the box, are false: such a side limits nothing.
    enter = std::max(enter, std::min(a, b) * (1 - 4e-7f));
    leave = std::min(leave, std::max(a, b) * (1 + 4e-7f));
  }
  return enter <= leave;
}

}  // namespace

MeshLight::MeshLight(std::string name, std::vector<Triangle> triangles, const Rgb& radiance, bool visible,
                     MemoryCharge charge)
    : Light(std::move(name), visible),
      charge_(std::move(charge)),
      triangles_(std::move(triangles)),
      radiance_(radiance) {
  std::erase_if(triangles_, [](const Triangle& t) { return !(twice_area(t).length() > 0); });
  PELAGE_CHECK(!triangles_.empty());
  build(0, static_cast<uint32_t>(triangles_.size()));
  double sum = 0;
  for (const Triangle& t : triangles_)
    below_.push_back(static_cast<float>(sum += twice_area(t).length() / 2));
  area_ = static_cast<float>(sum);
  for (float& below : below_) below /= area_;
  const Box3f& box = nodes_.front().box;
  ball_.center = box.center();
  for (const Triangle& t : triangles_) {
    for (const V3f& corner : t.corners)
      ball_.radius = std::max(ball_.radius, (corner - ball_.center).length());
  }
}

void MeshLight::build(uint32_t first, uint32_t count) {
  const size_t index = nodes_.size();
  nodes_.push_back({{}, 0, first, count});
  Box3f box, centers;
  const auto center = [](const Triangle& t) { return t.corners[0] + t.corners[1] + t.corners[2]; };
  for (uint32_t i = first; i < first + count; ++i) {
    for (const V3f& corner : triangles_[i].corners) box.extendBy(corner);
    centers.extendBy(center(triangles_[i]));
  }
  nodes_[index].box = box;
  if (count <= kLeaf) return;
  const auto axis = static_cast<int>(centers.majorAxis());
  const auto begin = triangles_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count,
                   [&](const Triangle& a, const Triangle& b) { return center(a)[axis] < center(b)[axis]; });
  build(first, count / 2);
  nodes_[index].second = static_cast<uint32_t>(nodes_.size());
  build(first + count / 2, count - count / 2);
}

std::optional<MeshLight::Crossing> MeshLight::nearest(const V3f& from, const V3f& direction) const {
  const V3f inverse(1 / direction.x, 1 / direction.y, 1 / direction.z);
  Crossing best;
  const auto faces = [&](uint32_t i) { return twice_area(triangles_[i]).dot(direction) < 0; };
  uint32_t stack[64], size = 0;  // the tree halves the count of triangles at each level
  stack[size++] = 0;
  while (size > 0) {
    const uint32_t index = stack[--size];
    const Node& node = nodes_[index];
    if (!meets(node.box, from, inverse, best.distance * (1 + kSame))) continue;
    if (node.second > 0) {
      stack[size++] = node.second;
      stack[size++] = index + 1;
      continue;
    }
    for (uint32_t i = node.first; i < node.first + node.count; ++i) {
      const float distance = cross(triangles_[i], from, direction);
      if (!std::isfinite(distance)) continue;
      // Of faces back to back, the one that faces the ray is seen.
      const bool is_same =
          std::isfinite(best.distance) && std::abs(distance - best.distance) <= kSame * best.distance;
      const bool is_nearer = is_same ? faces(i) && !faces(best.triangle) : distance < best.distance;
      if (is_nearer) best = {distance, i};
    }
  }
  return std::isfinite(best.distance) ? std::optional(best) : std::nullopt;
}

V3f MeshLight::normal(uint32_t triangle) const { return twice_area(triangles_[triangle]).normalized(); }

std::optional<LightSample> MeshLight::sample(const V3f& from, const V2f& u) const {
  const auto at = std::min(std::upper_bound(below_.begin(), below_.end(), u.x), below_.end() - 1);
  const auto index = static_cast<uint32_t>(at - below_.begin());
  const float before = index > 0 ? below_[index - 1] : 0.0f;
  const float place = *at > before ? std::clamp((u.x - before) / (*at - before), 0.0f, 1.0f) : 0.5f;
  const Triangle& t = triangles_[index];
  const float root = std::sqrt(place);
  const V3f point =
      t.corners[0] * (1 - root) + t.corners[1] * (root * (1 - u.y)) + t.corners[2] * (root * u.y);
  const V3f to = point - from, n = normal(index);
  const float distance = to.length();
  const float cosine = -to.dot(n) / distance;
  if (!(cosine > 0)) return std::nullopt;
  const V3f direction = to / distance;
  const std::optional<Crossing> seen = nearest(from, direction);
  if (seen && seen->distance < distance * (1 - kSame)) return std::nullopt;
  return LightSample{direction, distance, radiance_, distance * distance / (cosine * area_), n};
}

std::optional<LightHit> MeshLight::intersect(const V3f& from, const V3f& direction) const {
  const std::optional<Crossing> seen = nearest(from, direction);
  if (!seen) return std::nullopt;
  const V3f n = normal(seen->triangle);
  if (!(direction.dot(n) < 0)) return std::nullopt;
  return LightHit{seen->distance, radiance_, n};
}

float MeshLight::pdf(const V3f& from, const V3f& direction) const {
  const std::optional<LightHit> hit = intersect(from, direction);
  return hit ? pdf_of_hit(from, direction, *hit) : 0.0f;
}

float MeshLight::pdf_of_hit(const V3f&, const V3f& direction, const LightHit& hit) const {
  return hit.distance * hit.distance / (-direction.dot(hit.normal) * area_);
}

float MeshLight::importance(const V3f& from) const {
  // The mean projected area of a convex body is a quarter of its area (Cauchy).
  const float distance2 = std::max((ball_.center - from).length2(), ball_.radius * ball_.radius);
  return luminance(radiance_) * std::min(area_ / (4 * distance2), 4 * kPi);
}

}  // namespace pelage
