// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "geom/strands.h"
#include "render/accel/strand_handle.h"

namespace pelage {

/// Keeps the strands that a thread copied last, because samples of neighbouring pixels often see the same
/// strands. One strand at a time is lent to the thread's HitGeometry.
class StrandCache {
 public:
  static constexpr size_t kCount = 1024;
  /// Max memory of the strands that are kept. If they need more, all but the last are dropped.
  static constexpr size_t kMaxBytes = size_t{1} << 20;

  /// Begins a tile. From now on, prefetched strands may replace strands of earlier tiles.
  void begin() { ++tile_; }
  /// Prefetches a strand: copies it before it is used. Does nothing if the copy would replace another strand
  /// of the same tile, or if memory is short. Call while no strand is lent.
  template <class Copy>
  void keep(const StrandHandle& handle, const Copy& copy) {
    Held& held = held_[index(handle)];
    if (held.handle == handle || held.tile == tile_ || bytes_ > kMaxBytes / 2) return;
    replace(held, handle, held.strand, copy);
  }
  /// Stores the strand of a handle in `strand_of_hit`. Calls copy(Strands&) if the strand is not kept here.
  template <class Copy>
  void lend(const StrandHandle& handle, Strands& strand_of_hit, const Copy& copy) {
    Held& held = held_[index(handle)];
    if (lent_ != &held) {
      take_back(strand_of_hit);
      std::swap(held.strand, strand_of_hit);
      lent_ = &held;
    }
    if (held.handle == handle) return;
    replace(held, handle, strand_of_hit, copy);
    if (bytes_ > kMaxBytes) drop_others(held, strand_of_hit.bytes());
  }
  /// Returns the max memory, in bytes.
  static size_t bytes_bound() { return kCount * sizeof(Held) + kMaxBytes; }
  /// Takes back the strand that was lent, if any. Call before other code uses `strand_of_hit`.
  void take_back(Strands& strand_of_hit) {
    if (lent_) std::swap(lent_->strand, strand_of_hit);
    lent_ = nullptr;
  }

 private:
  struct Held {
    StrandHandle handle;
    uint32_t tile = 0;  // when it was copied
    Strands strand;
  };
  static size_t index(const StrandHandle& handle) { return hash64(handle.chunk, handle.index) % kCount; }
  /// `strand`: where the strand of `held` is now.
  template <class Copy>
  void replace(Held& held, const StrandHandle& handle, Strands& strand, const Copy& copy) {
    held.handle = {};
    bytes_ -= std::min(bytes_, strand.bytes());
    copy(strand);
    held.handle = handle;
    held.tile = tile_;
    bytes_ += strand.bytes();
  }
  void drop_others(const Held& keep, size_t bytes) {
    for (Held& held : held_) {
      if (&held != &keep) held = {};
    }
    bytes_ = bytes;
  }

  std::vector<Held> held_ = std::vector<Held>(kCount);
  Held* lent_ = nullptr;
  size_t bytes_ = 0;  // of all strands
  uint32_t tile_ = 0;
};

}  // namespace pelage
