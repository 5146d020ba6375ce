// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// Many small boxes that together contain one chunk, stored in few bytes. The sides of a box are stored as 0
/// to 255 steps from a corner of the chunk. The corner moves linearly while the shutter is open. The boxes
/// are the leaves of an implicit tree: each box of a coarser level contains up to four consecutive boxes of
/// the next finer level. Therefore consecutive boxes should be close together.
///
/// Immutable once constructed.
class SegmentCellBounds {
 public:
  /// Four boxes: group[axis][0][i] and group[axis][1][i] are the low and the high side of box i, in steps. If
  /// there are fewer than four boxes, low > high on every axis for the missing ones.
  using Group = std::array<std::array<std::array<uint8_t, 4>, 2>, 3>;

  /// `corner`: the position of step 0 at shutter open. `motion`: its motion from shutter open to close.
  /// `step`: the length of a step along each axis.
  struct Grid {
    V3f corner{0}, motion{0}, step{0};
  };

  /// Makes no boxes, which means that nothing is known about the chunk.
  SegmentCellBounds() = default;
  /// Makes boxes that contain the given boxes. Box b at key k is boxes[b * keys + k]. No given box may be
  /// empty. Keys are at evenly spaced times from shutter open to close. The contents of a box must move
  /// linearly between keys.
  SegmentCellBounds(std::span<const Box3f> boxes, size_t keys);
  /// Makes boxes from stored data. `finest`: the groups of the finest level. `count`: number of boxes of this
  /// level.
  SegmentCellBounds(const Grid& grid, std::span<const Group> finest, size_t count);

  /// Number of boxes of the finest level.
  size_t count() const { return count_; }
  const Grid& grid() const { return grid_; }
  /// Returns the groups of a level. Level 0 is the finest. Level levels() - 1 is the coarsest and has one
  /// group.
  std::span<const Group> level(size_t level) const {
    return std::span(groups_).subspan(first_group(level), group_count(level));
  }
  size_t levels() const { return levels_; }
  /// Returns box b of the finest level at a time of the shutter: 0 at shutter open, 1 at close.
  Box3f box(size_t b, float time) const;
  /// Returns whether low <= high for every box, and all numbers of the grid are finite. False if stored data
  /// is damaged.
  bool is_possible() const;
  /// Heap memory.
  size_t bytes() const { return groups_.capacity() * sizeof(Group); }
  /// Number of groups for this number of boxes.
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
