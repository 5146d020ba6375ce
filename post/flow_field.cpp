// SPDX-License-Identifier: Apache-2.0
#include "post/flow_field.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace pelage {

FlowField::FlowField(int width, int height, std::vector<Flow> motion, std::vector<float> depth,
                     const LinkLimits& limits, const Workers& workers, const std::vector<uint8_t>* is_thin)
    : width_(width),
      height_(height),
      motion_(std::move(motion)),
      depth_(std::move(depth)),
      // Linked neighbours differ by at most tear / largest_time; a corner is a mean over three of them.
      slack_(limits.largest_time > 0 ? 2 * limits.tear / limits.largest_time : 2 * kLongest) {
  PELAGE_CHECK(width > 0 && height > 0 && width <= kLargestSide && height <= kLargestSide);
  const size_t pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
  PELAGE_CHECK(motion_.size() == pixels && depth_.size() == pixels);
  links_.resize(pixels);
  const auto rows = [&](auto&& work) {
    workers.for_each(static_cast<size_t>(height), 16, [&](WorkRange range) {
      for (size_t y = range.begin; y < range.end; ++y) work(static_cast<int>(y));
    });
  };
  rows([&](int y) {
    for (int x = 0; x < width_; ++x) clean(at(x, y));
  });
  rows([&](int y) { link_row(y, limits); });
  // Marks are collected separately from the links, which other rows read meanwhile.
  std::vector<uint8_t> marks(pixels);
  const auto mark = [&](auto&& find) {
    rows([&](int y) {
      for (int x = 0; x < width_; ++x) marks[at(x, y)] = find(x, y);
    });
    rows([&](int y) {
      for (int x = 0; x < width_; ++x) links_[at(x, y)] |= marks[at(x, y)];
    });
  };
  mark([&](int x, int y) { return are_four_linked(x, y) ? kFour : 0; });
  mark([&](int x, int y) { return has_own_corners(x, y) ? kRigid : 0; });
  mark([&](int x, int y) {
    const bool may_hide = !is_thin || !(*is_thin)[at(x, y)];
    return may_hide && is_occluded(x, y) ? kSeam : 0;
  });
  bound_blocks();
}

void FlowField::clean(size_t pixel) {
  Flow& m = motion_[pixel];
  if (!std::isfinite(m.x) || !std::isfinite(m.y)) m = {};
  m = cut(m);
  float& z = depth_[pixel];
  z = std::abs(z);
  if (!(z > 0)) z = std::numeric_limits<float>::infinity();
}

bool FlowField::is_linked(size_t a, size_t b, const LinkLimits& limits) const {
  const float dx = std::abs(motion_[a].x - motion_[b].x), dy = std::abs(motion_[a].y - motion_[b].y);
  if (std::max(dx, dy) * limits.largest_time > limits.tear) return false;
  const float near = 1 / std::min(depth_[a], depth_[b]), far = 1 / std::max(depth_[a], depth_[b]);
  return near - far <= limits.depth_step * near;
}

void FlowField::link_row(int y, const LinkLimits& limits) {
  for (int x = 0; x < width_; ++x) {
    const size_t p = at(x, y);
    uint8_t bits = 0;
    if (x + 1 < width_ && is_linked(p, p + 1, limits)) bits |= kRight;
    if (y + 1 < height_ && is_linked(p, at(x, y + 1), limits)) bits |= kDown;
    links_[p] = bits;
  }
}

bool FlowField::are_four_linked(int x, int y) const {
  if (x + 1 >= width_ || y + 1 >= height_) return false;
  const int links = linked_right(x, y) + linked_down(x, y) + linked_right(x, y + 1) + linked_down(x + 1, y);
  return links >= 3;
}

Flow FlowField::torn_corner(int x, int y, int right, int bottom) const {
  // The four pixels around the corner: a b over c d. Outside of the picture there are no pixels and no links.
  const int left = x + right - 1, top = y + bottom - 1;
  const bool in_l = left >= 0, in_r = left + 1 < width_, in_t = top >= 0, in_b = top + 1 < height_;
  const size_t a = static_cast<size_t>(static_cast<int64_t>(top) * width_ + left);
  const size_t w = static_cast<size_t>(width_);
  const bool ab = in_t && in_l && in_r && (links_[a] & kRight);
  const bool cd = in_b && in_l && in_r && (links_[a + w] & kRight);
  const bool ac = in_l && in_t && in_b && (links_[a] & kDown);
  const bool bd = in_r && in_t && in_b && (links_[a + 1] & kDown);

  // Which of them are connected with this pixel, by at most three links.
  const int self = (bottom ? 0 : 2) + (right ? 0 : 1);
  bool in[4] = {self == 0, self == 1, self == 2, self == 3};
  for (int step = 0; step < 3; ++step) {
    if (ab) in[0] = in[1] = in[0] || in[1];
    if (cd) in[2] = in[3] = in[2] || in[3];
    if (ac) in[0] = in[2] = in[0] || in[2];
    if (bd) in[1] = in[3] = in[1] || in[3];
  }
  // In a fixed order, as differences to one of them.
  const size_t pixels[4] = {a, a + 1, a + w, a + w + 1};
  int count = 0;
  Flow first, sum;
  for (int i = 0; i < 4; ++i) {
    if (!in[i]) continue;
    const Flow m = motion_[pixels[i]];
    if (count++ == 0) first = m;
    sum.x += m.x - first.x;
    sum.y += m.y - first.y;
  }
  return {first.x + sum.x / static_cast<float>(count), first.y + sum.y / static_cast<float>(count)};
}

bool FlowField::has_own_corners(int x, int y) const {
  const Flow m = motion(x, y);
  for (int c = 0; c < 4; ++c) {
    if (corner(x, y, c & 1, c >> 1) != m) return false;
  }
  return true;
}

bool FlowField::is_behind(int x, int y, int other_x, int other_y) const {
  const size_t p = at(x, y), q = at(other_x, other_y);
  return depth_[p] != depth_[q] ? depth_[p] > depth_[q] : p > q;
}

bool FlowField::is_occluded(int x, int y) const {
  const auto hides = [&](int i, int j, bool is_linked) {
    return !is_linked && is_behind(x, y, i, j) && std::isfinite(depth_[at(x, y)]);
  };
  return (x > 0 && hides(x - 1, y, linked_right(x - 1, y))) ||
         (y > 0 && hides(x, y - 1, linked_down(x, y - 1))) ||
         (x + 1 < width_ && hides(x + 1, y, linked_right(x, y))) ||
         (y + 1 < height_ && hides(x, y + 1, linked_down(x, y)));
}

void FlowField::bound_blocks() {
  const auto widen = [](Flow& low, Flow& high, Flow min, Flow max) {
    low = {std::min(low.x, min.x), std::min(low.y, min.y)};
    high = {std::max(high.x, max.x), std::max(high.y, max.y)};
  };
  low_ = high_ = motion_[0];
  for (int y0 = 0; y0 < height_; y0 += kBlockHeight) {
    const Flow first = motion(0, y0);
    Block row{0, y0, width_, std::min(y0 + kBlockHeight, height_), first, first};
    for (int x0 = 0; x0 < width_; x0 += kBlockWidth) {
      Block block{x0, y0, std::min(x0 + kBlockWidth, width_), row.y1, {}, {}};
      block.low = block.high = motion(x0, y0);
      for (int y = block.y0; y < block.y1; ++y) {
        for (int x = block.x0; x < block.x1; ++x) {
          const Flow m = motion(x, y);
          widen(block.low, block.high, m, m);
        }
      }
      widen(row.low, row.high, block.low, block.high);
      blocks_.push_back(block);
    }
    widen(low_, high_, row.low, row.high);
    block_rows_.push_back(row);
  }
}

}  // namespace pelage
