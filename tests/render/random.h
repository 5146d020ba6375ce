// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/hash.h"
#include "base/vector.h"
#include "render/sampling/warp.h"

namespace pelage {

/// Plain independent random numbers for tests: what clever samplers are measured against.
class TestRandom {
 public:
  explicit TestRandom(uint64_t seed) : state_(hash64(seed, random_use("test"))) {}
  float unit() { return unit_float(mix64(state_ += 0x9e3779b97f4a7c15ull)); }
  float between(float low, float high) { return low + (high - low) * unit(); }
  V2f unit2() {
    const float x = unit();
    return {x, unit()};
  }
  V3f unit3() {
    const V2f xy = unit2();
    return {xy.x, xy.y, unit()};
  }
  V3f direction() { return uniform_direction(unit2()); }

 private:
  uint64_t state_;
};

/// Unit vector at inclination theta from the normal plane of z and azimuth phi from x.
inline V3f inclined(float theta, float phi) {
  return {std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi), std::sin(theta)};
}

}  // namespace pelage
