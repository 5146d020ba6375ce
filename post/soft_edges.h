// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "post/flow_field.h"

namespace pelage {

/// Pixels that a filter gave some coverage (alpha between 0 and 1) but in which no surface was met have no
/// depth and no vector of their own: left alone they would stay behind when their surface moves.
inline bool is_soft_edge(float alpha, float depth) {
  const float distance = depth < 0 ? -depth : depth;
  return alpha > 0 && alpha < 1 && !(distance > 0 && distance < std::numeric_limits<float>::infinity());
}

inline constexpr int kSoftEdgeReach = 2;

/// Gives each marked pixel depth and vector of the nearest surface within kSoftEdgeReach pixels, if there is
/// one. `motion` may be empty. Equal depths: the one that comes first.
void join_soft_edges(int width, int height, const std::vector<uint8_t>& is_soft, std::vector<float>& depth,
                     std::vector<Flow>& motion);

}  // namespace pelage
