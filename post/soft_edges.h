// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "post/flow_field.h"

namespace pelage {

/// Classification of a pixel by its alpha, as bits.
inline constexpr uint8_t kPartlyCovered = 1;  ///< alpha between 0 and 1: an edge, or something thin
inline constexpr uint8_t kSoftEdge = 2;       ///< partly covered, and without a depth

/// Soft edges are pixels to which a filter gave some coverage, although no ray of the pixel hit a surface.
/// They have neither a depth nor a vector. Without changes, they would stay behind when their surface moves.
inline uint8_t edge_bits(float alpha, float depth) {
  if (!(alpha > 0 && alpha < 1)) return 0;
  const float distance = depth < 0 ? -depth : depth;
  const bool has_depth = distance > 0 && distance < std::numeric_limits<float>::infinity();
  return has_depth ? kPartlyCovered : kPartlyCovered | kSoftEdge;
}

inline constexpr int kSoftEdgeReach = 2;

/// Gives each soft edge the depth and vector of the nearest surface within kSoftEdgeReach pixels, if there is
/// one; in case of a tie, of the first such surface. `motion` may be empty.
void join_soft_edges(int width, int height, const std::vector<uint8_t>& edges, std::vector<float>& depth,
                     std::vector<Flow>& motion);

}  // namespace pelage
