// SPDX-License-Identifier: Apache-2.0
#include "post/fill_holes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/check.h"

namespace pelage {
namespace {

/// Step of 1 / depth, as a fraction, by which a sample may be nearer than the border.
constexpr float kSameSurface = 0.05f;

bool is_nearer(const Sample& sample, const Sample& border) {
  return 1 / border.depth() < (1 - kSameSurface) / sample.depth();
}

bool is_gap(const Sample& sample) { return sample.is_empty() || sample.is_seam(); }

/// Fills `count` samples from `gap` in direction `step`; the border is the sample before it.
void fill_from(std::span<Sample> row, std::span<uint8_t> filled, ptrdiff_t gap, ptrdiff_t step, int count) {
  const auto size = static_cast<ptrdiff_t>(row.size());
  const Sample border = row[static_cast<size_t>(gap - step)];
  const auto is_background = [&](ptrdiff_t at) {
    const auto i = static_cast<size_t>(at);
    return !is_gap(row[i]) && filled[i] != kFilled && !is_nearer(row[i], border);
  };
  // Anything farther away than twice the gap is not its background.
  const ptrdiff_t reach = 2 * ptrdiff_t{count};
  const auto is_within = [&](ptrdiff_t at) { return at >= 0 && at < size && std::abs(gap - at) <= reach; };
  ptrdiff_t mirrored = gap - step;
  for (int i = 0; i < count; ++i) {
    const auto to = static_cast<size_t>(gap + i * step);
    row[to] = row[static_cast<size_t>(mirrored)];
    filled[to] = kFilled;
    ptrdiff_t next = mirrored - step;
    while (is_within(next) && !is_background(next)) next -= step;
    if (is_within(next)) mirrored = next;
  }
}

}  // namespace

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

void fill_gaps(std::span<Sample> row, std::span<uint8_t> filled, int longest, RowEnds ends) {
  PELAGE_CHECK(row.size() == filled.size());
  const auto size = static_cast<ptrdiff_t>(row.size());
  for (ptrdiff_t begin = 0; begin < size; ++begin) {
    if (!is_gap(row[static_cast<size_t>(begin)])) continue;
    ptrdiff_t end = begin;
    for (; end < size && is_gap(row[static_cast<size_t>(end)]); ++end)
      row[static_cast<size_t>(end)] = Sample();
    const bool has_left = begin > 0 && filled[static_cast<size_t>(begin - 1)] != kFilled,
               has_right = end < size;
    const int count = static_cast<int>(std::min<ptrdiff_t>(end - begin, longest));
    const auto depth = [&](ptrdiff_t at) { return row[static_cast<size_t>(at)].depth(); };
    if (has_left && (has_right ? depth(begin - 1) >= depth(end) : ends.right_is_cut)) {
      fill_from(row, filled, begin, 1, count);
    } else if (has_right && (has_left || ends.left_is_cut)) {
      fill_from(row, filled, end - 1, -1, count);
    }
    begin = end;
  }
}

}  // namespace pelage
