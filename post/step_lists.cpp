// SPDX-License-Identifier: Apache-2.0
#include "post/step_lists.h"

#include <algorithm>
#include <cmath>

namespace pelage {

void StepLists::gather(const Warp& warp, const std::vector<float>& times, const PixelBox& samples,
                       std::vector<const FlowField::Block*>& blocks) {
  by_step_.resize(times.size());
  for (auto& list : by_step_) list.clear();
  count_ = 0;
  if (!std::is_sorted(times.begin(), times.end())) return;
  const float largest = std::max(std::abs(times.front()), std::abs(times.back()));
  std::erase_if(blocks, [&](const FlowField::Block* block) {
    return spread(block->low, block->high) * largest > kWild && add(warp, *block, times, largest, samples);
  });
}

bool StepLists::add(const Warp& warp, const FlowField::Block& block, const std::vector<float>& times,
                    float largest, const PixelBox& samples) {
  const size_t max = times.size() * FlowField::kBlockWidth * FlowField::kBlockHeight;
  if (count_ + max > kMaxPixels) return false;
  for (int y = block.y0; y < block.y1; ++y) {
    for (int x = block.x0; x < block.x1; ++x) {
      const Warp::Times near = warp.times_near(x, y, largest, samples);
      if (near.last < near.first) continue;
      const auto from = std::lower_bound(times.begin(), times.end(), near.first);
      for (auto t = from; t != times.end() && *t <= near.last; ++t) {
        by_step_[static_cast<size_t>(t - times.begin())].push_back(
            {static_cast<uint16_t>(x), static_cast<uint16_t>(y)});
        ++count_;
      }
    }
  }
  return true;
}

}  // namespace pelage
