// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "render/light/light_set.h"

namespace pelage {

/// Points on the infinitely far lights of a scene, sampled once per frame: what Light::sample() returns for
/// one random place in each cell of a grid over its random numbers. Looking up a point costs less than
/// searching the tables of a large image, which rarely are in the processor's caches.
///
/// The cells are so small that the random numbers of a sample keep their stratification. The mean over the
/// seeds is the mean of Light::sample(). For one seed, an environment is replaced by kSide * kSide
/// directions. Immutable; thread safe.
class FarLightSamples {
 public:
  static constexpr uint32_t kSide = 128;

  /// `lights` must outlive this object. `stores`: if false, no points are stored; sample() is
  /// Light::sample().
  FarLightSamples(const LightSet& lights, uint64_t seed, bool stores);

  /// Returns a stored point, or Light::sample() if the light is not infinitely far. `u`: two random
  /// numbers in [0, 1).
  std::optional<LightSample> sample(size_t light, const V3f& from, const V2f& u) const {
    const std::vector<Point>& points = points_[light];
    if (points.empty()) return lights_.light(light).sample(from, u);
    const Point& point = points[cell(u.y) * kSide + cell(u.x)];
    if (!(point.pdf > 0)) return std::nullopt;
    return LightSample{point.direction, std::numeric_limits<float>::infinity(), point.radiance, point.pdf,
                       V3f(0)};
  }
  /// Returns the memory, in bytes, of the points on these lights.
  static size_t bytes(const LightSet& lights);

 private:
  /// As in LightSample. pdf 0: there is none.
  struct alignas(32) Point {
    V3f direction{0};
    Rgb radiance{0};
    float pdf = 0;
  };
  static size_t cell(float u) { return static_cast<size_t>(u * static_cast<float>(kSide)); }

  const LightSet& lights_;
  std::vector<std::vector<Point>> points_;  // by light; empty: not infinitely far
};

}  // namespace pelage
