// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pelage {

/// Returns the least level at which 2^level parts of `length` are no longer than `spacing`, but at most 16.
inline int level_of(float length, float spacing) {
  constexpr int kMaxLevel = 16;
  if (!(length > spacing)) return 0;
  return std::min(static_cast<int>(std::ceil(std::log2(length / spacing))), kMaxLevel);
}

/// Chooses one of the two gather points around `place`. There are 2^level + 1 gather points in [0, 1]. The
/// nearer one is more likely. `random`: in [0, 1).
inline uint32_t gather_point_near(float place, int level, float random) {
  const float scaled = std::clamp(place, 0.0f, 1.0f) * static_cast<float>(1 << level);
  const float before = std::floor(scaled);
  return static_cast<uint32_t>(before) + (random < scaled - before ? 1 : 0);
}

/// Returns a number that identifies a gather point among the gather points of all levels.
inline uint64_t pack(int level, uint32_t gather_point) {
  return static_cast<uint64_t>(level) << 32 | gather_point;
}

}  // namespace pelage
