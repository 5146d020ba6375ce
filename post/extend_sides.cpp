// SPDX-License-Identifier: Apache-2.0
#include "post/extend_sides.h"

#include <algorithm>
#include <cmath>

namespace pelage {

void extend_sides(const FlowField& field, const WarpTarget& target, RowEnds cut, int max, int row,
                  std::span<Sample> line, std::span<uint8_t> filled) {
  const int y = row / target.scale + target.origin_y;
  if (y < 0 || y >= field.height()) return;
  const auto scale = static_cast<float>(target.scale), end = static_cast<float>(line.size());
  const auto draw = [&](int from, int to) {
    const float left = scale * (static_cast<float>(to - target.origin_x) + field.motion(from, y).x);
    const auto first_centre = [&](float edge) {
      return static_cast<size_t>(std::clamp(std::ceil(edge - 0.5f), 0.0f, end));
    };
    const Sample sample(field.depth(from, y), from, y);
    for (size_t i = first_centre(left); i < first_centre(left + scale); ++i) {
      const bool is_free = line[i].is_empty() || (filled[i] == kExtended && sample.is_nearer_than(line[i]));
      if (!is_free) continue;
      line[i] = sample;
      filled[i] = kExtended;
    }
  };
  const int width = field.width();
  for (int k = 0; k < std::min(max, width); ++k) {
    if (cut.left_is_cut) draw(k, -1 - k);
    if (cut.right_is_cut) draw(width - 1 - k, width + k);
  }
}

}  // namespace pelage
