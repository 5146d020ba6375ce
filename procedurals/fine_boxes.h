// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// Many small boxes around what one chunk holds, in few bytes: each side is a whole number of steps, 0 to
/// 255, from a corner of the chunk, which moves linearly over the shutter. Over them stands a tree of which
/// nothing but the boxes is kept: each box of a level above the finest holds four that follow each other in
/// the level below, so boxes that follow each other should be neighbours.
///
/// Immutable once made.
class FineBoxes {
 public:
  /// By axis, the low and the high sides of four boxes. Those of absent boxes are inside out on every axis.
  using Group = std::array<std::array<std::array<uint8_t, 4>, 2>, 3>;

  /// Where the steps are counted from, at shutter open; how far that moves until shutter close; how long they
  /// are.
  struct Grid {
    V3f corner{0}, motion{0}, step{0};
  };

  /// No boxes: nothing is known of the chunk.
  FineBoxes() = default;
  /// Boxes that hold `boxes`, which are not empty: box b at key k, even times of the shutter, is
  /// boxes[b * keys + k], and between two keys what it holds moves linearly.
  FineBoxes(std::span<const Box3f> boxes, size_t keys);
  /// As they were written: the finest level and its number of boxes.
  FineBoxes(const Grid& grid, std::span<const Group> finest, size_t count);

  /// Of the finest level.
  size_t count() const { return count_; }
  const Grid& grid() const { return grid_; }
  /// The groups of a level; 0 is the finest. The highest has one group.
  std::span<const Group> level(size_t level) const {
    return std::span(groups_).subspan(first_group(level), group_count(level));
  }
  size_t levels() const { return levels_; }
  /// Box b of the finest level at a time of the shutter.
  Box3f box(size_t b, float time) const;
  /// Whether every box is the right way round and the grid finite: false after reading nonsense.
  bool is_possible() const;
  /// Of the heap.
  size_t bytes() const { return groups_.capacity() * sizeof(Group); }
  static size_t groups_of(size_t boxes) { return (boxes + 3) / 4; }

 private:
  size_t group_count(size_t level) const;
  size_t first_group(size_t level) const;
  void add_levels();

  Grid grid_;
  std::vector<Group> groups_;  // the finest level first
  uint32_t count_ = 0, levels_ = 0;
};

}  // namespace pelage
