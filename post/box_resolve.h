// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "post/layers.h"
#include "post/work_buffer.h"

namespace pelage {

/// Converts work buffers to pixels with equal weights for all samples. Counts are integers, so a pixel that
/// sees only one pixel of the source is an exact copy of this source pixel, for any number of samples. NaN
/// colours count as zero in averages.
///
/// Colours are read once for each run of steps in which a pixel sees the same pixels of the source. Thread
/// safety: one thread at a time; use one per worker.
class BoxResolve {
 public:
  /// `with_colors`: otherwise channels of role kColor are not written.
  explicit BoxResolve(const PostLayers& layers, bool with_colors = true)
      : layers_(layers), with_colors_(with_colors) {}

  /// Starts pixels `box` of the result.
  void begin(const PixelBox& box, int scale);
  /// Adds the samples of one step, or of `steps` equal steps. `buffer` must cover the box.
  void add(const WorkBuffer& buffer, int steps = 1);
  /// Writes the pixels of the box.
  void finish();

  /// Temporary memory per pixel of the box.
  static size_t bytes_per_pixel(const PostLayers& layers) {
    return layers.channels.size() * sizeof(float) + sizeof(State) + 2 * sizeof(Entry);
  }

 private:
  struct Entry {
    uint32_t at;      // pixel of the box
    uint32_t source;  // Sample::pixel()
    uint32_t count;
  };
  struct State {
    Sample front;  // nearest of all samples
    uint32_t source = 0;
    uint32_t count = 0;     // samples of `source` that are not yet in the sums
    bool is_mixed = false;  // the sums are not empty
  };
  static constexpr size_t kMaxEntries = 1 << 14;

  void see(uint32_t at, uint32_t source, uint32_t count);
  void flush();
  void add_to_matte(const RankedMatte& matte, const Entry& entry);
  void write_matte(size_t matte, uint32_t at, int x, int y);
  void write_pixel(uint32_t at, int x, int y);

  const PostLayers& layers_;
  bool with_colors_;
  PixelBox box_;
  int scale_ = 1;
  uint32_t samples_ = 0;  // per pixel, over all steps so far
  std::vector<State> states_;
  std::vector<Entry> entries_;
  std::vector<float> sums_;  // by channel
  std::vector<std::vector<std::pair<uint32_t, float>>>
      matte_sums_;  // by matte and pixel: bits of the id, sum
};

}  // namespace pelage
