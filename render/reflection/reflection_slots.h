// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/vector.h"
#include "render/reflection/reflection_table.h"

namespace pelage {

/// A radiance in 64 bits: per channel a float without sign, with 8 bits of exponent and 13 of mantissa. The
/// error is at most 2^-14 of each channel, if that is a normal float. Channels that are negative or not a
/// number become 0.
class PackedRadiance {
 public:
  static uint64_t pack(const Rgb& radiance) {
    return channel(radiance.x) | channel(radiance.y) << kBits | channel(radiance.z) << 2 * kBits;
  }
  static Rgb unpack(uint64_t packed) {
    return {value(packed), value(packed >> kBits), value(packed >> 2 * kBits)};
  }

 private:
  static constexpr int kBits = 21, kLeftOut = 31 - kBits;  // the last bits of a mantissa
  static constexpr uint32_t kMask = (1u << kBits) - 1;

  static uint64_t channel(float value) {
    constexpr uint32_t kHalf = 1u << (kLeftOut - 1);
    const uint32_t most = std::bit_cast<uint32_t>(std::numeric_limits<float>::max()) >> kLeftOut;
    if (!(value > 0)) return 0;
    return std::min((std::bit_cast<uint32_t>(value) + kHalf) >> kLeftOut, most);
  }
  static float value(uint64_t channels) {
    return std::bit_cast<float>((static_cast<uint32_t>(channels) & kMask) << kLeftOut);
  }
};

/// The finished cells of a reflection cache, arranged for reading: a hash table with open addressing and
/// linear probing. A slot has the key of a cell and its radiance by light, 8 bytes each, so with one light, a
/// cache line holds four slots, and a lookup mostly waits for memory once. Filled by one thread, slice by
/// slice. After that it does not change: any thread may read at any time, without a lock.
class ReflectionSlots {
 public:
  /// The mean radiance of a cell, by light. Converts to false where there is no cell.
  class Radiance {
   public:
    Radiance() = default;
    explicit Radiance(const uint64_t* packed) : packed_(packed) {}
    explicit operator bool() const { return packed_ != nullptr; }
    Rgb operator[](size_t light) const { return PackedRadiance::unpack(packed_[light]); }

   private:
    const uint64_t* packed_ = nullptr;
  };

  /// How densely cells are stored: as fast to read as possible, or in as little memory as possible.
  enum class Density { kFast, kSmall };

  /// `room`: max count of cells at a time.
  ReflectionSlots(size_t lights, size_t room, Density density = Density::kFast);

  /// Copies the cells of a table after its finish(), except those whose largest cell has fewer than `fewest`
  /// paths. The keys must be new.
  void add(const ReflectionTable& table, uint32_t fewest);
  /// Removes all cells of a level.
  void drop(uint32_t level);

  /// Returns the radiance of the cell with this key and level (ReflectionTable::Cell), if there is one.
  Radiance find(uint64_t key, uint32_t level) const;
  /// Returns the count of cells.
  size_t size() const { return size_; }
  size_t bytes() const { return slots_.size() * sizeof(uint64_t); }
  /// Returns bytes() with room for so many cells.
  static size_t bytes(size_t room, size_t lights, Density density = Density::kFast) {
    return slots_for(room, density) * words(lights) * sizeof(uint64_t);
  }

 private:
  static constexpr uint64_t kLevelBits = 3;  // mask
  /// Two thirds or 85 % of the slots are used.
  static size_t slots_for(size_t room, Density density) {
    return room + (density == Density::kFast ? room / 2 : room / 100 * 18 + 18) + 2;
  }
  static size_t words(size_t lights) { return 1 + lights; }
  /// Returns what a slot stores as key: the level of the cell plus one replaces the last bits of its key.
  static uint64_t stored(uint64_t key, uint32_t level) { return (key & ~kLevelBits) | (level + 1); }
  uint64_t& key_at(size_t slot) { return slots_[slot * words_]; }
  uint64_t key_at(size_t slot) const { return slots_[slot * words_]; }
  /// Returns the slot where the search for a key starts. Keys are hashes.
  size_t home(uint64_t key) const { return static_cast<size_t>((key >> 32) * count_ >> 32); }
  size_t after(size_t slot) const { return slot + 1 < count_ ? slot + 1 : 0; }
  void remove(size_t slot);

  size_t words_, count_, size_ = 0;  // words of 64 bits per slot; slots; cells
  std::vector<uint64_t> slots_;
};

}  // namespace pelage
