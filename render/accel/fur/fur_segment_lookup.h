// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/page_block.h"
#include "render/accel/fur/fur_tree.h"

namespace pelage {

/// Maps segment numbers of a fur tree to their position in its leaves. Two bytes per segment where the tree
/// is small and has no wide leaf, otherwise four. Thread safety: immutable.
class FurSegmentLookup {
 public:
  FurSegmentLookup() = default;
  /// Traverses a tree over segments 0 .. segment_count - 1.
  FurSegmentLookup(const FurTreeView& tree, uint32_t segment_count);

  /// A lane of a block.
  struct Place {
    const std::byte* block = nullptr;  ///< null for a segment that is in no leaf
    size_t lane = 0;
    bool wide = false;
  };
  /// `tree` must be unchanged, but may have moved in memory.
  Place find(const FurTreeView& tree, uint32_t number) const;

  size_t bytes() const { return block_.bytes(); }
  static size_t bytes_bound(size_t segments) { return PageBlock::held_bytes(4 * segments); }

 private:
  PageBlock block_;
  bool short_ = false;
};

}  // namespace pelage
