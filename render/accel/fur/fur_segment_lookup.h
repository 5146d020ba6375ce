// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/page_block.h"
#include "render/accel/fur/fur_tree.h"

namespace pelage {

/// Maps the segment numbers of a fur tree to positions in the tree's leaves. Takes two bytes per segment if
/// the tree is small (at most 16383 blocks) and has no wide leaf, otherwise four bytes. Thread safety:
/// immutable.
class FurSegmentLookup {
 public:
  FurSegmentLookup() = default;
  /// Finds the positions by traversing `tree`, whose segments have the numbers 0 .. segment_count - 1.
  FurSegmentLookup(const FurTreeView& tree, uint32_t segment_count);

  /// The position of a segment: a lane of a block.
  struct Place {
    const std::byte* block = nullptr;  ///< null for a segment that is in no leaf
    size_t lane = 0;
    bool wide = false;
  };
  /// Returns the position of segment `number`. `tree` must be the tree passed to the constructor, with the
  /// same contents; its memory may have moved.
  Place find(const FurTreeView& tree, uint32_t number) const;

  size_t bytes() const { return block_.bytes(); }
  static size_t bytes_bound(size_t segments) { return PageBlock::held_bytes(4 * segments); }

 private:
  PageBlock block_;
  bool short_ = false;
};

}  // namespace pelage
