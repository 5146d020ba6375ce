// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "post/warp.h"

namespace pelage {

/// For one tile of the picture and each step in time, holds a list of the pixels of the flow field that may
/// reach the tile at that time. Used for blocks of the field whose vectors differ very much. The bounds of
/// such a block would reach almost every tile at every step, so drawing whole blocks would cost pixels *
/// tiles * steps. With the lists, the cost is pixels * tiles. Does not affect the result.
///
/// Thread safety: only one thread at a time may use an instance; use one per worker.
class StepLists {
 public:
  struct Pixel {
    uint16_t x, y;
  };

  /// Clears the lists. Then removes from `blocks` each block whose pixels move apart by more than kWild
  /// pixels until the time with the largest absolute value, and lists the pixels of this block instead. When
  /// the lists are full, the remaining blocks stay in `blocks`. If `times` are not ascending, lists nothing
  /// and leaves `blocks` unchanged. `samples`: the samples of the tile.
  void gather(const Warp& warp, const std::vector<float>& times, const PixelBox& samples,
              std::vector<const FlowField::Block*>& blocks);
  /// Returns the listed pixels for times[step].
  const std::vector<Pixel>& at(size_t step) const { return by_step_[step]; }

  /// Returns whether any block of the field may need lists, given the largest absolute value of the times.
  static bool is_needed(const FlowField& field, float largest) {
    return spread(field.low(), field.high()) * largest > kWild;
  }
  /// Max number of pixels in all lists together.
  static constexpr size_t kMaxPixels = 1 << 19;
  /// Max memory in bytes: kMaxPixels pixels, doubled because a growing list is copied.
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
