// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <vector>

#include "base/hash.h"
#include "cache/residency.h"

namespace pelage {

/// A unit whose every word says which slot it belongs to, and which is poisoned before it is freed.
class CanaryUnit final : public Resident {
 public:
  CanaryUnit(uint32_t slot, size_t words, std::atomic<int64_t>& live)
      : slot_(slot), words_(words), data_(new uint64_t[words]), live_(live) {
    for (size_t i = 0; i < words; ++i) data_[i] = word(slot, i);
  }
  ~CanaryUnit() override {
    std::memset(data_.get(), 0xDD, words_ * sizeof(uint64_t));
    data_.reset();
    live_.fetch_sub(static_cast<int64_t>(words_ * sizeof(uint64_t)));
    slot_ = 0xDDDDDDDD;
  }
  /// Whether a few words are those of `slot`; `where` chooses among them.
  bool is_whole(uint32_t slot, uint64_t where) const {
    return slot_ == slot && data_[0] == word(slot, 0) && data_[words_ - 1] == word(slot, words_ - 1) &&
           data_[where % words_] == word(slot, where % words_);
  }

 private:
  static uint64_t word(uint32_t slot, size_t i) { return (uint64_t(slot) << 32 | 0x5AFE0000u) + i; }

  uint32_t slot_;
  size_t words_;
  std::unique_ptr<uint64_t[]> data_;
  std::atomic<int64_t>& live_;
};

inline bool is_whole(Resident& unit, uint32_t slot, uint64_t where = 1) {
  return static_cast<CanaryUnit&>(unit).is_whole(slot, where);
}

/// Grows canary units of random sizes, which need twice their bytes while they grow, and counts what is
/// alive.
class TestGrower : public Grower {
 public:
  TestGrower(size_t slots, size_t max_words, uint64_t seed = 1) {
    for (size_t slot = 0; slot < slots; ++slot) words_.push_back(1 + hash64(seed, slot) % max_words);
  }
  static TestGrower of_equal_units(size_t slots, size_t words) {
    TestGrower grower(slots, 1);
    grower.words_.assign(slots, words);
    return grower;
  }
  TestGrower(TestGrower&& other) noexcept : words_(std::move(other.words_)) {}

  size_t bytes(uint32_t slot) const { return words_[slot] * sizeof(uint64_t); }
  size_t all_bytes() const {
    size_t sum = 0;
    for (uint32_t slot = 0; slot < words_.size(); ++slot) sum += bytes(slot);
    return sum;
  }
  size_t largest_reservation() const {
    size_t max = 0;
    for (uint32_t slot = 0; slot < words_.size(); ++slot) max = std::max(max, reserve_bytes(slot));
    return max;
  }
  int64_t live_bytes() const { return live_; }
  int64_t live_peak() const { return live_peak_; }
  int64_t grown() const { return grown_; }

  size_t reserve_bytes(uint32_t slot) const override { return 2 * bytes(slot); }
  Grown grow(uint32_t slot) override {
    const auto reserved = static_cast<int64_t>(reserve_bytes(slot));
    note_peak(live_.fetch_add(reserved) + reserved);
    const uint64_t number = static_cast<uint64_t>(grown_.fetch_add(1));
    try {
      if (before) before(slot, number);
    } catch (...) {
      live_.fetch_sub(reserved);
      throw;
    }
    auto unit = std::make_unique<CanaryUnit>(slot, words_[slot], live_);
    live_.fetch_sub(reserved - static_cast<int64_t>(bytes(slot)));
    return {std::move(unit), bytes(slot)};
  }

  /// Called in every growth with the slot and the number of the growth; may block or throw.
  std::function<void(uint32_t, uint64_t)> before;

 private:
  void note_peak(int64_t now) {
    int64_t peak = live_peak_;
    while (now > peak && !live_peak_.compare_exchange_weak(peak, now)) {
    }
  }

  std::vector<size_t> words_;
  std::atomic<int64_t> live_{0};
  std::atomic<int64_t> live_peak_{0};
  std::atomic<int64_t> grown_{0};
};

}  // namespace pelage
