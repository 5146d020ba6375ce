// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "post/warp.h"

namespace pelage {

/// Lists of the pixels that reach a tile of the picture at each step, for blocks of the field whose vectors
/// differ so much that the blocks' bounds are useless: every block would reach every tile at every step, at a
/// cost of pixels * tiles * steps. With the lists the cost is pixels * tiles. Does not affect pixels.
///
/// Thread safety: one thread at a time; use one per worker.
class StepLists {
 public:
  struct Pixel {
    uint16_t x, y;
  };

  /// Removes from `blocks` all blocks whose vectors diverge by more than kWild pixels between two times, and
  /// lists the pixels of these blocks instead. When the lists are full, the other blocks stay. `times` may be
  /// in any order; only times in ascending order are listed.
  void gather(const Warp& warp, const std::vector<float>& times, const PixelBox& samples,
              std::vector<const FlowField::Block*>& blocks);
  const std::vector<Pixel>& at(size_t step) const { return by_step_[step]; }

  /// Whether any block of the field may need lists at times up to `largest`.
  static bool is_needed(const FlowField& field, float largest) {
    return spread(field.low(), field.high()) * largest > kWild;
  }
  /// Capacity of kMaxPixels pixels, twice that while a list grows.
  static constexpr size_t kMaxPixels = 1 << 19;
  static constexpr size_t bytes_needed() { return 2 * kMaxPixels * sizeof(Pixel); }

 private:
  static constexpr float kWild = 128;
  static float spread(Flow low, Flow high) { return std::max(high.x - low.x, high.y - low.y); }
  bool add(const Warp& warp, const FlowField::Block& block, const std::vector<float>& times, float largest,
           const PixelBox& samples);

  std::vector<std::vector<Pixel>> by_step_;
  size_t count_ = 0;
};

}  // namespace pelage
