// SPDX-License-Identifier: Apache-2.0
#include "bench/furball.h"

#include <cmath>
#include <numbers>

#include "base/hash.h"

namespace pelage {
namespace {

constexpr float kTwoPi = 2 * std::numbers::pi_v<float>;

float number(uint64_t i, uint64_t use) { return unit_float(hash64(i, use, random_use("furball"))); }

V3f direction(uint64_t i, uint64_t use) {
  const float z = 2 * number(i, use) - 1, s = std::sqrt(1 - z * z), phi = kTwoPi * number(i, use + 1);
  return {s * std::cos(phi), s * std::sin(phi), z};
}

}  // namespace

Strands make_furball(size_t strand_count) {
  constexpr int kPoints = 8;
  constexpr float kLength = 0.15f, kBend = 0.8f, kCurl = 0.02f, kTurns = 1;
  const float width = 8e-4f * std::sqrt(1e5f / static_cast<float>(strand_count));
  StrandArrays a;
  a.first_point.push_back(0);
  for (uint64_t i = 0; i < strand_count; ++i) {
    const V3f normal = direction(i, 0);
    const V3f comb = (V3f(0, -1, 0) + normal.y * normal + V3f(1e-4f, 0, 0)).normalized();
    const V3f side = normal.cross(comb).normalized();
    const float phase = kTwoPi * number(i, 2);
    for (int k = 0; k < kPoints; ++k) {
      const float v = static_cast<float>(k) / (kPoints - 1), angle = phase + kTwoPi * kTurns * v;
      const V3f p = (1 + kLength * v) * normal + (kBend * kLength * v * v) * comb +
                    (kCurl * v) * (std::cos(angle) * side + std::sin(angle) * comb);
      a.points.insert(a.points.end(), {p.x, p.y, p.z, 0.5f * width * (1 - 0.9f * v)});
    }
    a.first_point.push_back(static_cast<uint32_t>((i + 1) * kPoints));
    a.ids.push_back(i);
  }
  return Strands(std::move(a));
}

std::vector<Ray> rays_deep_in_furball(size_t count) {
  std::vector<Ray> rays(count);
  for (uint64_t i = 0; i < count; ++i) {
    const V3f normal = direction(i, 10), way = direction(i, 13);
    rays[i].origin = (1 + 0.12f * number(i, 12)) * normal;
    rays[i].direction = way.dot(normal) < 0 ? -way : way;
  }
  return rays;
}

std::vector<Ray> camera_rays_at_furball(size_t pixels) {
  std::vector<Ray> rays;
  for (uint64_t i = 0; i < pixels * pixels; ++i) {
    const float x = (static_cast<float>(i % pixels) + number(i, 20)) / static_cast<float>(pixels) - 0.5f;
    const float y = (static_cast<float>(i / pixels) + number(i, 21)) / static_cast<float>(pixels) - 0.5f;
    Ray ray;
    ray.origin = {0, 0, 4.7f};
    ray.direction = V3f(0.5f * x, 0.5f * y, -1).normalized();
    rays.push_back(ray);
  }
  return rays;
}

}  // namespace pelage
