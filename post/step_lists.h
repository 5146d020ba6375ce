// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "post/warp.h"

namespace pelage {

/// Which pixels reach a piece of the picture at each step, where vectors differ so much within blocks of the
/// field that the blocks' bounds tell nothing: every block would reach every piece at every step, and the
/// cost would be pixels * pieces * steps. With the lists it is pixels * pieces. Changes no pixel.
///
/// Thread safety: one thread at a time; use one per worker.
class StepLists {
 public:
  struct Pixel {
    uint16_t x, y;
  };

  /// Takes out of `blocks` those whose vectors part by more than kWild pixels between two times, and lists
  /// their pixels instead. When the lists are full, the other blocks stay. `times` in any order; only those
  /// in ascending order are listed.
  void gather(const Warp& warp, const std::vector<float>& times, const PixelBox& samples,
              std::vector<const FlowField::Block*>& blocks);
  const std::vector<Pixel>& at(size_t step) const { return by_step_[step]; }

  /// Whether any block of the field may be listed at times up to `largest`.
  static bool is_needed(const FlowField& field, float largest) {
    return spread(field.low(), field.high()) * largest > kWild;
  }
  /// Room for kMaxPixels pixels, twice that while a list grows.
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
