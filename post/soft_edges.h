// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "post/flow_field.h"

namespace pelage {

/// Bits that classify a pixel by its alpha and depth.
inline constexpr uint8_t kPartlyCovered = 1;  ///< 0 < alpha < 1: an edge or a thin object
inline constexpr uint8_t kSoftEdge = 2;       ///< 0 < alpha < 1, and the depth is zero, infinite or NaN

/// Returns the bits of a pixel. Soft edges are pixels that got some coverage from the pixel filter, although
/// no ray of the pixel itself hit a surface. They have no depth and no vector, so they would not move with
/// their surface; see join_soft_edges().
inline uint8_t edge_bits(float alpha, float depth) {
  if (!(alpha > 0 && alpha < 1)) return 0;
  const float distance = depth < 0 ? -depth : depth;
  const bool has_depth = distance > 0 && distance < std::numeric_limits<float>::infinity();
  return has_depth ? kPartlyCovered : kPartlyCovered | kSoftEdge;
}

/// Max distance in x and y, in pixels, between a soft edge and the pixel of its surface.
inline constexpr int kSoftEdgeReach = 2;

/// Gives each soft edge the depth and vector of the pixel with the smallest depth among the other pixels
/// within kSoftEdgeReach. If several have this depth, uses the first of them in row order. If there is no
/// such pixel, leaves the soft edge unchanged. `motion` may be empty.
void join_soft_edges(int width, int height, const std::vector<uint8_t>& edges, std::vector<float>& depth,
                     std::vector<Flow>& motion);

}  // namespace pelage
