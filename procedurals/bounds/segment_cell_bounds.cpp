// SPDX-License-Identifier: Apache-2.0
#include "procedurals/bounds/segment_cell_bounds.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace pelage {
namespace {

constexpr int kMaxSteps = 255;
constexpr float kSmallestStep = 1e-30f;  // a normal number whatever the processor does to others

/// In double precision, so that rounding is negligible relative to the error bound of every ray test.
struct Extent {
  double low[3] = {INFINITY, INFINITY, INFINITY};
  double high[3] = {-INFINITY, -INFINITY, -INFINITY};

  void add(const Extent& e) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], e.low[i]);
      high[i] = std::max(high[i], e.high[i]);
    }
  }
};

SegmentCellBounds::Group empty_group() {
  SegmentCellBounds::Group group;
  for (auto& axis : group) {
    axis[0].fill(kMaxSteps);
    axis[1].fill(0);
  }
  return group;
}

/// Computes the box around the four boxes of a group.
void join(const SegmentCellBounds::Group& group, SegmentCellBounds::Group& into, size_t lane) {
  for (size_t i = 0; i < 3; ++i) {
    into[i][0][lane] = *std::min_element(group[i][0].begin(), group[i][0].end());
    into[i][1][lane] = *std::max_element(group[i][1].begin(), group[i][1].end());
  }
}

}  // namespace

SegmentCellBounds::SegmentCellBounds(std::span<const Box3f> boxes, size_t keys)
    : count_(uint32_t(boxes.size() / keys)) {
  if (count_ == 0) return;
  Box3f open, close;
  for (size_t b = 0; b < count_; ++b) {
    open.extendBy(boxes[b * keys]);
    close.extendBy(boxes[b * keys + keys - 1]);
  }
  grid_.motion = close.min - open.min;

  // Contents move linearly from key to key, and the corner from the first to the last: so the largest
  // distances between them occur at keys.
  std::vector<Extent> extents(count_);
  Extent all;
  for (size_t b = 0; b < count_; ++b) {
    for (size_t k = 0; k < keys; ++k) {
      const double time = keys < 2 ? 0 : static_cast<double>(k) / static_cast<double>(keys - 1);
      const Box3f& box = boxes[b * keys + k];
      for (int i = 0; i < 3; ++i) {
        extents[b].low[i] = std::min(extents[b].low[i], box.min[i] - time * grid_.motion[i]);
        extents[b].high[i] = std::max(extents[b].high[i], box.max[i] - time * grid_.motion[i]);
      }
    }
    all.add(extents[b]);
  }
  for (int i = 0; i < 3; ++i) {
    grid_.corner[i] = std::nextafter(static_cast<float>(all.low[i]), -INFINITY);
    const double step = (all.high[i] - static_cast<double>(grid_.corner[i])) / kMaxSteps;
    grid_.step[i] = std::max(std::nextafter(static_cast<float>(step), INFINITY), kSmallestStep);
  }

  groups_.assign(groups_of(count_), empty_group());
  for (size_t b = 0; b < count_; ++b) {
    for (int i = 0; i < 3; ++i) {
      auto& sides = groups_[b / 4][static_cast<size_t>(i)];
      const double corner = grid_.corner[i], step = grid_.step[i];
      const double low = std::floor((extents[b].low[i] - corner) / step);
      const double high = std::ceil((extents[b].high[i] - corner) / step);
      PELAGE_CHECK(low >= 0 && high <= kMaxSteps);
      sides[0][b % 4] = static_cast<uint8_t>(low);
      sides[1][b % 4] = static_cast<uint8_t>(high);
    }
  }
  add_levels();
}

SegmentCellBounds::SegmentCellBounds(const Grid& grid, std::span<const Group> finest, size_t count)
    : grid_(grid), count_(static_cast<uint32_t>(count)) {
  PELAGE_CHECK(finest.size() == groups_of(count));
  if (count_ == 0) return;
  groups_.assign(finest.begin(), finest.end());
  add_levels();
}

void SegmentCellBounds::add_levels() {
  size_t total = 0, levels = 0;
  for (size_t n = groups_of(count_);; n = groups_of(n)) {
    total += n;
    ++levels;
    if (n == 1) break;
  }
  groups_.reserve(total);
  levels_ = static_cast<uint32_t>(levels);
  for (size_t below = 0; groups_.size() < total;) {
    const size_t end = groups_.size();
    for (; below < end; below += 4) {
      Group joined = empty_group();
      for (size_t lane = 0; lane < std::min<size_t>(4, end - below); ++lane) {
        join(groups_[below + lane], joined, lane);
      }
      groups_.push_back(joined);
    }
    below = end;
  }
}

size_t SegmentCellBounds::group_count(size_t level) const {
  size_t n = groups_of(count_);
  for (size_t i = 0; i < level; ++i) n = groups_of(n);
  return n;
}

size_t SegmentCellBounds::first_group(size_t level) const {
  size_t first = 0, n = groups_of(count_);
  for (size_t i = 0; i < level; ++i) {
    first += n;
    n = groups_of(n);
  }
  return first;
}

Box3f SegmentCellBounds::box(size_t b, float time) const {
  Box3f box;
  for (int i = 0; i < 3; ++i) {
    const auto& sides = groups_[b / 4][static_cast<size_t>(i)];
    const float corner = grid_.corner[i] + time * grid_.motion[i];
    box.min[i] = corner + static_cast<float>(sides[0][b % 4]) * grid_.step[i];
    box.max[i] = corner + static_cast<float>(sides[1][b % 4]) * grid_.step[i];
  }
  return box;
}

bool SegmentCellBounds::is_possible() const {
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(grid_.corner[i]) || !std::isfinite(grid_.motion[i])) return false;
    if (!std::isfinite(grid_.step[i]) || grid_.step[i] < 0) return false;
  }
  for (size_t b = 0; b < count_; ++b) {
    for (const auto& axis : groups_[b / 4]) {
      if (axis[0][b % 4] > axis[1][b % 4]) return false;
    }
  }
  return true;
}

}  // namespace pelage
