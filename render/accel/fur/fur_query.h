// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "render/accel/fur/fur_folds.h"
#include "render/accel/fur/fur_hit.h"
#include "render/accel/fur/fur_ray.h"

// The scalar part of the intersection kernels: it processes single lanes of a block.
namespace pelage {

/// The curve in one lane of a block, in ray space.
struct FurLane : PlaneCurve {
  float z, dz[3];  ///< distance along the ray: the first point, and differences as for x and y
  float r[4];

  float depth(float u) const {
    const float s = 1 - u, second = dz[0] + dz[1];
    return z + (3 * (s * s * u) * dz[0] + (3 * (s * u * u) * second + u * u * u * (second + dz[2])));
  }

  static float value(const float (&p)[4], float u) {
    const float s = 1 - u;
    return (s * s * s * p[0] + 3 * (s * s * u) * p[1]) + (3 * (s * u * u) * p[2] + u * u * u * p[3]);
  }
  /// Returns the derivative at u of a coordinate. `d`: the differences of its consecutive Bezier points.
  static float first(const float (&d)[3], float u) {
    const float s = 1 - u;
    return 3 * (s * s * d[0] + 2 * s * u * d[1] + u * u * d[2]);
  }
};

/// Whether a hit on the strand that the ray starts on is a self-intersection: it is within two strand widths
/// of the start, both along the ray and along the strand.
inline bool is_start(const FurRay& ray, uint32_t number, const FurLane& lane, float u, float distance) {
  const float twice = 4 * FurLane::value(lane.r, u);
  if (!(distance < twice)) return false;
  const float x = FurLane::first(lane.dx, u), y = FurLane::first(lane.dy, u), z = FurLane::first(lane.dz, u);
  const float between = static_cast<float>(number - ray.start.first_segment) + u - ray.start.place;
  return std::abs(between) * std::sqrt(x * x + y * y + z * z) < twice;
}

/// Query for the nearest hit. take() returns false: the ray always continues.
class NearestFur {
 public:
  /// `only`: number of the only segment that may be hit; kNone: any.
  NearestFur(const FurRay& ray, FurFilter* filter, float step, uint32_t only = FurHit::kNone)
      : near_(ray.near), step_(step), only_(only), filter_(filter) {
    hit.distance = ray.far;
  }
  float far() const { return hit.distance; }
  static constexpr bool kOrdered = true;

  /// Whether a hit at this distance on segment `number` precedes the current hit.
  bool wants(float distance, uint32_t number) const {
    return distance > near_ &&
           (distance < hit.distance || (hit && distance == hit.distance && number < hit.number)) &&
           (only_ == FurHit::kNone || only_ == number);
  }
  bool take(const FurHit& found) {
    if (filter_) {
      FurHit scene = found;
      scene.distance *= step_;
      if (!filter_->accepts(scene)) return false;
    }
    hit = found;
    return false;
  }
  FurHit hit;

 private:
  float near_, step_;
  uint32_t only_;
  FurFilter* filter_;
};

/// Query for any hit. take() returns whether the filter accepted the hit, which finishes the ray.
class AnyFur {
 public:
  AnyFur(const FurRay& ray, FurFilter* filter, float step)
      : near_(ray.near), far_(ray.far), step_(step), filter_(filter) {}
  float far() const { return far_; }
  static constexpr bool kOrdered = false;
  bool wants(float distance, uint32_t) const { return distance > near_ && distance < far_; }
  bool take(FurHit found) {
    found.distance *= step_;
    hit = !filter_ || filter_->accepts(found);
    return hit;
  }
  bool hit = false;

 private:
  float near_, far_, step_;
  FurFilter* filter_;
};

inline bool is_on_start(const FurRay& ray, uint32_t number) {
  return number - ray.start.first_segment < ray.start.segment_count;
}

/// Tests a curve whose distance to the ray may have several minima. Returns true when the ray is finished.
template <class Query>
[[gnu::noinline]] bool test_folded(const FurLane& lane, uint32_t number, const FurRay& ray, Query& query) {
  float us[3];
  const size_t count = nearest_parameters(lane, us);
  for (size_t i = 0; i < count; ++i) {
    const float u = us[i];
    const float cx = FurLane::value(lane.x, u), cy = FurLane::value(lane.y, u),
                radius = FurLane::value(lane.r, u);
    const float distance2 = cx * cx + cy * cy;
    if (!(distance2 < radius * radius)) continue;
    const float t = lane.depth(u);
    if (!query.wants(t, number)) continue;
    if (is_on_start(ray, number) && is_start(ray, number, lane, u, t)) continue;
    const float side = FurLane::first(lane.dx, u) * cy - FurLane::first(lane.dy, u) * cx;
    if (query.take({t, number, u, std::copysign(std::sqrt(distance2) / radius, side)})) return true;
  }
  return false;
}

}  // namespace pelage
