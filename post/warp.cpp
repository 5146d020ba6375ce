// SPDX-License-Identifier: Apache-2.0
#include "post/warp.h"

namespace pelage {

Warp::Point Warp::seam_reach(float time) const {
  const auto part = [&](float low, float high) {
    return std::min(target_.longest_seam, time * (high - low + 2 * field_.slack()) + 1);
  };
  const Flow low = field_.low(), high = field_.high();
  return {part(low.x, high.x), part(low.y, high.y)};
}

Warp::Times Warp::times_near(int x, int y, float largest, const PixelBox& samples) const {
  // One pixel more than needed, because the times are rounded.
  const Point margin = margin_at(largest), from = place(x, y, {}, 0);
  const auto scale = static_cast<float>(target_.scale);
  const Flow m = field_.motion(x, y);
  Times times{-largest, largest};
  const auto clip = [&](float at, float speed, float low, float high) {
    if (speed == 0) {
      if (at < low || at > high) times = {0, -1};
      return;
    }
    const float a = (low - at) / speed, b = (high - at) / speed;
    times = {std::max(times.first, std::min(a, b)), std::min(times.last, std::max(a, b))};
  };
  clip(from.x, scale * m.x, static_cast<float>(samples.x0) - margin.x - scale,
       static_cast<float>(samples.x1) + margin.x + scale);
  if (times.last < times.first) return times;
  clip(from.y, scale * m.y, static_cast<float>(samples.y0) - margin.y - scale,
       static_cast<float>(samples.y1) + margin.y + scale);
  return times;
}

bool Warp::reaches(const FlowField::Block& block, const PixelBox& samples, float first, float last) const {
  const auto scale = static_cast<float>(target_.scale);
  // One sample more than needed on each side, because bounds and corners are rounded differently.
  const float largest_time = std::max(std::abs(first), std::abs(last));
  const Point seam = seam_reach(largest_time);
  const auto reach = [&](int begin, int end, float low, float high, int origin, float longest_seam, int s0,
                         int s1) {
    const float slack = field_.slack() * largest_time + longest_seam;
    const float min = std::min({first * low, first * high, last * low, last * high}) - slack;
    const float max = std::max({first * low, first * high, last * low, last * high}) + slack;
    return scale * (static_cast<float>(end - origin) + max) + 1 >= static_cast<float>(s0) &&
           scale * (static_cast<float>(begin - origin) + min) - 1 <= static_cast<float>(s1);
  };
  return reach(block.y0, block.y1, block.low.y, block.high.y, target_.origin_y, seam.y, samples.y0,
               samples.y1) &&
         reach(block.x0, block.x1, block.low.x, block.high.x, target_.origin_x, seam.x, samples.x0,
               samples.x1);
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
