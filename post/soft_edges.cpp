// SPDX-License-Identifier: Apache-2.0
#include "post/soft_edges.h"

#include <algorithm>
#include <cmath>

namespace pelage {

void join_soft_edges(int width, int height, const std::vector<uint8_t>& edges, std::vector<float>& depth,
                     std::vector<Flow>& motion) {
  const auto at = [&](int x, int y) {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!(edges[at(x, y)] & kSoftEdge)) continue;
      // Soft pixels are not used as sources, so the order in which they are joined does not matter.
      float nearest = std::numeric_limits<float>::infinity();
      size_t giver = at(x, y);
      for (int j = std::max(0, y - kSoftEdgeReach); j <= std::min(height - 1, y + kSoftEdgeReach); ++j) {
        for (int i = std::max(0, x - kSoftEdgeReach); i <= std::min(width - 1, x + kSoftEdgeReach); ++i) {
          const float distance = std::abs(depth[at(i, j)]);
          if ((edges[at(i, j)] & kSoftEdge) || !(distance > 0) || !(distance < nearest)) continue;
          nearest = distance;
          giver = at(i, j);
        }
      }
      depth[at(x, y)] = depth[giver];
      if (!motion.empty()) motion[at(x, y)] = motion[giver];
    }
  }
}

}  // namespace pelage
