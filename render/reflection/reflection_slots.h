// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "render/reflection/reflection_table.h"

namespace pelage {

/// The finished cells of a reflection cache, arranged for reading: a hash table with open addressing and
/// linear probing. The key of a cell and its radiance by light lie side by side, with up to two lights in
/// half a cache line. So a lookup mostly waits for memory once. Does not change after its construction: any
/// thread may read at any time, without a lock.
class ReflectionSlots {
  struct alignas(32) HalfLine {
    std::array<float, 8> values{};
  };

 public:
  /// The mean radiance of a cell, by light. Converts to false where there is no cell.
  class Radiance {
   public:
    Radiance() = default;
    explicit Radiance(const HalfLine* slot) : slot_(slot) {}
    explicit operator bool() const { return slot_ != nullptr; }
    Rgb operator[](size_t light) const {
      const size_t first = kKeyFloats + 3 * light;
      return {value(first), value(first + 1), value(first + 2)};
    }

   private:
    float value(size_t i) const { return slot_[i / kFloats].values[i % kFloats]; }
    const HalfLine* slot_ = nullptr;
  };

  /// Copies the cells of a table after its finish(), except those whose largest cell has fewer than `fewest`
  /// paths.
  ReflectionSlots(const ReflectionTable& table, size_t lights, uint32_t fewest);

  Radiance find(uint64_t key) const;
  /// Returns the count of cells.
  size_t size() const { return size_; }
  size_t bytes() const { return slots_.size() * sizeof(HalfLine); }
  /// Returns an upper bound of bytes() for a table with up to so many cells.
  static size_t max_bytes(size_t cells, size_t lights) {
    return slots_for(cells, lights) * half_lines(lights) * sizeof(HalfLine);
  }

 private:
  static constexpr size_t kFloats = 8, kKeyFloats = 2;
  /// Two thirds of the slots are used; half of them where each slot fills a cache line or more, because then,
  /// each further step of a search waits for memory.
  static size_t slots_for(size_t cells, size_t lights) {
    return (half_lines(lights) == 1 ? cells + cells / 2 : 2 * cells) + 2;
  }
  static size_t half_lines(size_t lights) { return (kKeyFloats + 3 * lights + kFloats - 1) / kFloats; }
  /// Returns where the search for a key starts: with the first of the slots of a cache line. Keys are hashes.
  size_t home(uint64_t key) const {
    const auto slot = static_cast<size_t>((key >> 32) * count_ >> 32);
    return half_lines_ == 1 ? slot & ~size_t{1} : slot;
  }
  HalfLine& insert(uint64_t key);

  size_t count_ = 0, size_ = 0;
  size_t half_lines_ = 1;  // per slot
  std::vector<HalfLine> slots_;
};

}  // namespace pelage
