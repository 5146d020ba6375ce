// SPDX-License-Identifier: Apache-2.0
#include "post/warp.h"

namespace pelage {

bool Warp::reaches(const FlowField::Block& block, const PixelBox& samples, float first, float last) const {
  const auto scale = static_cast<float>(target_.scale);
  // A sample more than needed on each side: bounds may round otherwise than corners do.
  const auto reach = [&](int begin, int end, float low, float high, int origin, int s0, int s1) {
    const float slack = field_.slack() * std::max(std::abs(first), std::abs(last)) + target_.longest_seam;
    const float least = std::min({first * low, first * high, last * low, last * high}) - slack;
    const float most = std::max({first * low, first * high, last * low, last * high}) + slack;
    return scale * (static_cast<float>(end - origin) + most) + 1 >= static_cast<float>(s0) &&
           scale * (static_cast<float>(begin - origin) + least) - 1 <= static_cast<float>(s1);
  };
  return reach(block.y0, block.y1, block.low.y, block.high.y, target_.origin_y, samples.y0, samples.y1) &&
         reach(block.x0, block.x1, block.low.x, block.high.x, target_.origin_x, samples.x0, samples.x1);
}

std::vector<const FlowField::Block*> Warp::reaching(const PixelBox& samples, float first_time,
                                                    float last_time) const {
  std::vector<const FlowField::Block*> found;
  const auto across = static_cast<size_t>(field_.blocks_across());
  for (size_t row = 0; row < field_.block_rows().size(); ++row) {
    if (!reaches(field_.block_rows()[row], samples, first_time, last_time)) continue;
    const FlowField::Block* const blocks = &field_.blocks()[row * across];
    for (size_t i = 0; i < across; ++i) {
      if (reaches(blocks[i], samples, first_time, last_time)) found.push_back(&blocks[i]);
    }
  }
  return found;
}

}  // namespace pelage
