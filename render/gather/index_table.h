// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pelage {

/// Numbers keys in the order in which they are first asked for: 0, 1, 2 ... Keys must be hashes, because
/// their low bits choose a slot. A hash table with open addressing, at most three quarters full.
class IndexTable {
 public:
  /// Forgets all keys. Keeps the memory.
  void clear() {
    if (count_ > 0) slots_.assign(slots_.size(), {});
    count_ = 0;
  }
  uint32_t size() const { return count_; }

  /// Returns the index of a key; the next free index if the key is new.
  uint32_t index(uint64_t key) {
    if (4 * size_t{count_ + 1} > 3 * slots_.size()) grow();
    Slot& slot = find(key);
    if (slot.index == kNone) slot = {key, count_++};
    return slot.index;
  }
  /// Returns the max memory per key, in bytes, of a table with many keys that grows.
  static constexpr size_t bytes_per_key() { return 4 * sizeof(Slot); }

 private:
  static constexpr uint32_t kNone = ~0u;
  static constexpr size_t kFewest = 64;
  struct Slot {
    uint64_t key = 0;
    uint32_t index = kNone;
  };

  Slot& find(uint64_t key) {
    const size_t mask = slots_.size() - 1;
    size_t at = key & mask;
    while (slots_[at].index != kNone && slots_[at].key != key) at = (at + 1) & mask;
    return slots_[at];
  }
  void grow() {
    std::vector<Slot> before(slots_.empty() ? kFewest : 2 * slots_.size());
    before.swap(slots_);
    for (const Slot& slot : before) {
      if (slot.index != kNone) find(slot.key) = slot;
    }
  }

  std::vector<Slot> slots_;  // their count is 0 or a power of two
  uint32_t count_ = 0;
};

}  // namespace pelage
