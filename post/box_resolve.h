// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "post/layers.h"
#include "post/work_buffer.h"

namespace pelage {

/// Converts the samples of work buffers to pixels. All samples of a pixel have the same weight. If all
/// samples of a pixel show the same source pixel, the pixel is an exact copy of this source pixel. In
/// averages, NaN colours count as zero.
///
/// Counts samples per source pixel first, so the colours of a source pixel are read only once for consecutive
/// steps that show it. Thread safety: only one thread at a time may use an instance; use one per worker.
class BoxResolve {
 public:
  /// `with_colors`: whether channels of role kColor are written.
  explicit BoxResolve(const PostLayers& layers, bool with_colors = true)
      : layers_(layers), with_colors_(with_colors) {}

  /// Starts the pixels of `box` of the result, with scale * scale samples per pixel in each step.
  void begin(const PixelBox& box, int scale);
  /// Adds the samples of a buffer `steps` times. The buffer must contain all samples of the box.
  void add(const WorkBuffer& buffer, int steps = 1);
  /// Writes the pixels of the box.
  void finish();

  /// Temporary memory in bytes per pixel of the box.
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
    Sample front;  // nearest of all samples so far
    uint32_t source = 0;
    uint32_t count = 0;     // samples of `source` that are not yet in the sums
    bool is_mixed = false;  // samples of other source pixels are in the sums
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
