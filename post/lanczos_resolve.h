// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "post/layers.h"
#include "post/work_buffer.h"

namespace pelage {

/// Computes the colours of pixels from the samples of a work buffer with a Lanczos filter [Neulander13]. The
/// filter is L(x) L(y) with L(t) = sinc(t) sinc(t / 3) for |t| < 3 pixels. Its negative lobes keep the
/// picture sharp. Against ringing, each result is clamped to the min and max of the colours in the
/// surrounding 3 x 3 pixels. Samples outside of the picture are ignored; empty samples inside count as zero.
/// Only channels of role kColor are written; BoxResolve writes the other channels.
///
/// Thread safety: only one thread at a time may use an instance; use one per worker.
class LanczosResolve {
 public:
  /// Number of rows above and below a row of pixels whose samples the filter reads.
  static constexpr int kReach = 3;

  LanczosResolve(const PostLayers& layers, int scale);

  /// Returns the memory in bytes for rows of this width in pixels. If neighbouring samples show source pixels
  /// that are scattered over the whole picture, more is needed.
  static size_t bytes_needed(int width, size_t channels, int scale);

  /// Writes the colours of all pixels of row `y`. `buffer` must contain the samples of rows y - kReach to y +
  /// kReach (of those inside the picture), from column 0 over the whole width of the picture.
  void write_row(const WorkBuffer& buffer, int y);

 private:
  struct Run {
    int begin;  // first sample of the run; the run ends where the next one begins
    Sample sample;
  };
  struct Part {
    uint32_t source;  // index in sources_
    float weight;
  };
  /// A pixel and the source pixels that contribute to it: parts_[first .. last). The parts before `near_last`
  /// are visible in the surrounding 3 x 3 pixels.
  struct Gathered {
    size_t first, near_last, last;
    float weight;  // of all samples inside the picture
    bool near_hole;
  };
  /// Contribution of a source to the current pixel so far.
  struct Share {
    float weight = 0;
    bool is_met = false, is_near = false;
  };

  void find_runs(const WorkBuffer& buffer, int y);
  bool is_repeated(size_t row, int begin, int end);
  Gathered gather(int x, int y, const PixelBox& samples);
  void add(uint32_t pixel, float weight, bool is_near);
  void fetch_colors();
  void resolve(const Gathered& pixel, int x, int y) const;
  void finish_segment(int x0, int y);

  int scale_, reach_;            // samples along a pixel's side; taps before and after its first sample
  std::vector<double> weights_;  // by tap
  std::vector<double> sums_to_;  // by tap: sum of the weights before the tap
  std::vector<std::vector<Run>> runs_;  // by sample row, with a sentinel at the end
  std::vector<size_t> first_run_;       // by sample row: index of the first run for the current pixel
  int runs_row_ = 0;                    // sample row of runs_[0]

  // Pixels are gathered in segments of a row. The colours of their source pixels are copied to one array,
  // with all channels of a source pixel side by side, so that SIMD code adds up a group of channels at once.
  static constexpr size_t kLanes = 16, kLongestSegment = 128, kEnoughSources = 1 << 12;
  std::vector<PostChannel> channels_;  // colours, the last one repeated to fill the lanes
  size_t color_count_ = 0;
  std::vector<Gathered> pixels_;
  std::vector<Part> parts_;
  std::vector<uint32_t> sources_;  // distinct source pixels (Sample::pixel())
  std::vector<Share> shares_;      // by source
  std::vector<uint32_t> met_;      // sources of the current pixel, in the order found
  std::vector<uint16_t> slots_;    // hash table: 1 + index in sources_; 0: free
  std::vector<float> colors_;      // channels_.size() values for each source
};

}  // namespace pelage
