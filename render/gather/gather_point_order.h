// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pelage {

/// Sorts items (rays or visible points of a tile) by group: by gather point, or by gather point and light.
/// Items of the same group keep their order. Takes time proportional to the count of items and groups
/// (counting sort). Reuses its memory.
class GatherPointOrder {
 public:
  /// Sorts items first .. first + count - 1. `group(i)` must return the group of item i, less than `groups`.
  template <class Group>
  void sort(size_t first, size_t count, size_t groups, const Group& group) {
    ends_.assign(groups + 1, 0);
    items_.resize(count);
    for (size_t i = first; i < first + count; ++i) ++ends_[group(i) + 1];
    for (size_t g = 1; g <= groups; ++g) ends_[g] += ends_[g - 1];
    // ends_[g] is now the begin of group g; placing its items moves it to the end.
    for (size_t i = first; i < first + count; ++i) items_[ends_[group(i)]++] = static_cast<uint32_t>(i);
  }

  /// Returns the items, sorted by group.
  std::span<const uint32_t> items() const { return items_; }
  /// Returns the items of consecutive groups: `count` groups from `first` on.
  std::span<const uint32_t> groups(size_t first, size_t count) const {
    const uint32_t begin = first == 0 ? 0 : ends_[first - 1];
    return items().subspan(begin, ends_[first + count - 1] - begin);
  }
  /// Returns the max memory, in bytes, for these counts.
  static size_t bytes(size_t items, size_t groups) { return (items + groups + 1) * sizeof(uint32_t); }

 private:
  std::vector<uint32_t> ends_;   // by group
  std::vector<uint32_t> items_;  // sorted
};

}  // namespace pelage
