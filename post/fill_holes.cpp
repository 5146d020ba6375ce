// SPDX-License-Identifier: Apache-2.0
#include "post/fill_holes.h"

#include <algorithm>

#include "base/check.h"

namespace pelage {
namespace {

/// Step of 1 / depth, as a fraction, within which the border's surface goes on.
constexpr float kSameSurface = 0.05f;

bool goes_on(const Sample& from, const Sample& to) {
  const float near = 1 / std::min(from.depth(), to.depth()), far = 1 / std::max(from.depth(), to.depth());
  return near - far <= kSameSurface * near;
}

bool is_gap(const Sample& sample) { return sample.is_empty() || sample.is_seam(); }

/// Fills `count` samples from `gap` in direction `step`; the border is the sample before it.
void fill_from(std::span<Sample> row, std::span<uint8_t> invented, ptrdiff_t gap, ptrdiff_t step, int count) {
  const auto size = static_cast<ptrdiff_t>(row.size());
  const Sample border = row[static_cast<size_t>(gap - step)];
  ptrdiff_t mirrored = gap - step;
  for (int i = 0; i < count; ++i) {
    const auto to = static_cast<size_t>(gap + i * step);
    row[to] = row[static_cast<size_t>(mirrored)];
    invented[to] = 1;
    const ptrdiff_t next = mirrored - step;
    if (next < 0 || next >= size) continue;
    const auto n = static_cast<size_t>(next);
    if (!is_gap(row[n]) && !invented[n] && goes_on(border, row[n])) mirrored = next;
  }
}

}  // namespace

void fill_gaps(std::span<Sample> row, std::span<uint8_t> invented, int longest, RowEnds ends) {
  PELAGE_CHECK(row.size() == invented.size());
  const auto size = static_cast<ptrdiff_t>(row.size());
  for (ptrdiff_t begin = 0; begin < size; ++begin) {
    if (!is_gap(row[static_cast<size_t>(begin)])) continue;
    ptrdiff_t end = begin;
    for (; end < size && is_gap(row[static_cast<size_t>(end)]); ++end)
      row[static_cast<size_t>(end)] = Sample();
    const bool has_left = begin > 0 && !invented[static_cast<size_t>(begin - 1)], has_right = end < size;
    const int count = static_cast<int>(std::min<ptrdiff_t>(end - begin, longest));
    const auto depth = [&](ptrdiff_t at) { return row[static_cast<size_t>(at)].depth(); };
    if (has_left && (has_right ? depth(begin - 1) >= depth(end) : ends.right_is_cut)) {
      fill_from(row, invented, begin, 1, count);
    } else if (has_right && (has_left || ends.left_is_cut)) {
      fill_from(row, invented, end - 1, -1, count);
    }
    begin = end;
  }
}

}  // namespace pelage
