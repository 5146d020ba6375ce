// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "render/reflection/cell_keys.h"

namespace pelage {

/// A slice of the cells of the reflection cache: those whose largest cell has a key in a range. A cell and
/// the larger cells around it are always in the same slice. Keys are hashes, so a quarter of all keys has
/// about a quarter of all cells. A range is counted in units of 2^32 keys.
class CellRange {
 public:
  static constexpr uint64_t kAll = uint64_t{1} << 32;

  /// Makes the first range. `length`: max length of each range, 1 to kAll.
  explicit CellRange(uint64_t length = kAll) : length_(length), most_(length) {}

  bool contains(const CellPath& cells) const {
    const uint64_t at = cells.back() >> 32;
    return at >= first_ && at - first_ < length_;
  }
  bool is_all() const { return first_ == 0 && length_ >= kAll; }
  /// Returns whether no keys are left: advance() has passed the last one.
  bool is_over() const { return first_ >= kAll; }
  /// Returns the part of all keys that is before this range.
  double share_before() const { return static_cast<double>(first_) / static_cast<double>(kAll); }
  /// Returns the part of all keys that is before the end of this range, at most 1.
  double share_done() const {
    const uint64_t end = first_ + length_;
    return end < kAll ? static_cast<double>(end) / static_cast<double>(kAll) : 1.0;
  }
  /// Returns whether halve() can be called: not where a range is so short that few largest cells are left.
  bool can_halve() const { return length_ > kAll >> 12; }
  void halve() { length_ = (length_ + 1) / 2; }
  /// Moves on to the keys after this range. If this range was halved, the next range is twice as long.
  void advance() {
    first_ += length_;
    length_ = length_ < most_ / 2 ? 2 * length_ : most_;
  }

 private:
  uint64_t first_ = 0, length_, most_;
};

}  // namespace pelage
