// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// Many small boxes around the contents of one chunk, in few bytes. Each side is 0 to 255 steps from a corner
/// of the chunk; the corner moves linearly over the shutter. The boxes are the leaves of an implicit tree:
/// each box of a coarser level contains four consecutive boxes of the level below, so consecutive boxes
/// should be close together.
///
/// Immutable once made.
class FineBoxes {
 public:
  /// Low and high sides of four boxes, by axis. Missing boxes are inverted on every axis.
  using Group = std::array<std::array<std::array<uint8_t, 4>, 2>, 3>;

  /// Origin of the steps at shutter open, its motion until shutter close, and the length of a step.
  struct Grid {
    V3f corner{0}, motion{0}, step{0};
  };

  /// No boxes: nothing is known about the chunk.
  FineBoxes() = default;
  /// Boxes that contain `boxes`, which must not be empty: box b at key k (evenly spaced times of the shutter)
  /// is boxes[b * keys + k]. The contents move linearly between keys.
  FineBoxes(std::span<const Box3f> boxes, size_t keys);
  /// From stored data: the finest level and its number of boxes.
  FineBoxes(const Grid& grid, std::span<const Group> finest, size_t count);

  /// Number of boxes of the finest level.
  size_t count() const { return count_; }
  const Grid& grid() const { return grid_; }
  /// The groups of a level; 0 is the finest. The highest has one group.
  std::span<const Group> level(size_t level) const {
    return std::span(groups_).subspan(first_group(level), group_count(level));
  }
  size_t levels() const { return levels_; }
  /// Box b of the finest level at a time of the shutter.
  Box3f box(size_t b, float time) const;
  /// Whether every box is well-formed and the grid finite: false after reading garbage.
  bool is_possible() const;
  /// Heap memory.
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
