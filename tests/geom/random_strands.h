// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "base/hash.h"
#include "geom/strands.h"

namespace pelage {

/// Size and shape of random test strands.
struct RandomStrandOptions {
  size_t strands = 50;
  uint32_t min_points = 2;
  uint32_t max_points = 12;
  int motion_keys = 1;
  float step = 0.1f;     ///< mean distance between points
  float wander = 1.0f;   ///< 0: straight; 1: every step in a new direction
  float radius = 0.02f;  ///< largest
  float motion = 0.2f;   ///< how far points move between keys
  V3f centre{0};
  CurveBasis basis = CurveBasis::kPinnedBSpline;
};

/// A batch of random strands; all its numbers come from `seed`.
inline Strands random_strands(uint64_t seed, const RandomStrandOptions& o = {}) {
  uint64_t draw = 0;
  const auto next = [&] { return signed_float(hash64(seed, draw++, random_use("random strands"))); };
  const auto vector = [&] {
    const float x = next(), y = next(), z = next();
    return V3f(x, y, z);
  };
  StrandArrays a;
  a.basis = o.basis;
  a.motion_keys = o.motion_keys;
  a.first_point.push_back(0);
  for (size_t s = 0; s < o.strands; ++s) {
    const float spread = static_cast<float>(o.max_points - o.min_points + 1);
    const uint32_t count = o.min_points + static_cast<uint32_t>(spread * 0.5f * (next() + 1.0f));
    a.first_point.push_back(a.first_point.back() + count);
    a.ids.push_back(s);
  }
  for (int key = 0; key < o.motion_keys; ++key) {
    draw = 1000;  // every key is the first one, moved
    uint64_t shift = 1u << 20;
    for (size_t s = 0; s < o.strands; ++s) {
      V3f p = o.centre + vector();
      V3f direction = vector();
      for (uint32_t i = a.first_point[s]; i < a.first_point[s + 1]; ++i) {
        const float r = o.radius * std::abs(next());
        V3f moved = p;
        for (int axis = 0; axis < 3; ++axis) {
          const uint64_t word = hash64(seed, shift++, key);
          if (key > 0) moved[axis] += o.motion * signed_float(word);
        }
        a.points.insert(a.points.end(), {moved.x, moved.y, moved.z, r});
        direction = (1.0f - o.wander) * direction + o.wander * vector();
        p += o.step * direction;
      }
    }
  }
  return Strands(std::move(a));
}

}  // namespace pelage
