// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "post/layers.h"
#include "post/work_buffer.h"

namespace pelage {

/// Turns a work buffer into pixels with a Lanczos-windowed sinc of three lobes, whose negative lobes keep the
/// picture sharp [Neulander13]: L(t) = sinc(t) sinc(t / 3) for |t| < 3 pixels, separable. What rings beyond
/// the least and the largest value within the 3 x 3 pixels around is cut off. Beyond the picture there is
/// nothing to average; holes inside count as zero. Data is of the front-most sample within the pixel, mattes
/// are averaged by BoxResolve.
///
/// Thread safety: one thread at a time; use one per worker.
class LanczosResolve {
 public:
  /// Pixels that the filter reaches beyond the one it is for.
  static constexpr int kReach = 3;

  LanczosResolve(const PostLayers& layers, int scale);

  /// What it holds while it works on rows of this width, unless pixels are scattered all over the picture.
  static size_t bytes_needed(int width, size_t channels, int scale);

  /// Writes the colours of row `y`, for which `buffer` holds rows y - kReach to y + kReach as far as the
  /// picture has them, over the whole width of the picture, from column 0 on.
  void write_row(const WorkBuffer& buffer, int y);

 private:
  struct Run {
    int begin;  // sample; ends where the next one begins
    Sample sample;
  };
  struct Part {
    uint32_t source;  // number in sources_
    float weight;
  };
  /// A pixel whose parts have been gathered: parts_[first .. last), those before `near_last` seen within the
  /// 3 x 3 pixels around.
  struct Gathered {
    size_t first, near_last, last;
    float weight;  // of all samples that are within the picture
    bool near_hole;
  };
  /// What the pixel at hand has of a source so far.
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

  int scale_, reach_;                   // samples per pixel; taps on each side of the pixel's first sample
  std::vector<double> weights_;         // by tap
  std::vector<double> sums_to_;         // of the weights before a tap
  std::vector<std::vector<Run>> runs_;  // by sample row, with one at the end that begins behind it
  std::vector<size_t> first_run_;       // of each row, for the pixel at hand
  int runs_row_ = 0;                    // sample row of runs_[0]

  // Pixels are gathered by the segment, and the colours of what they see put side by side: sums are then
  // over whole groups of channels.
  static constexpr size_t kLanes = 16, kLongestSegment = 128, kEnoughSources = 1 << 12;
  std::vector<PostChannel> channels_;  // colours, the last one repeated to fill the lanes
  size_t color_count_ = 0;
  std::vector<Gathered> pixels_;
  std::vector<Part> parts_;
  std::vector<uint32_t> sources_;  // distinct pixels
  std::vector<Share> shares_;      // by source
  std::vector<uint32_t> met_;      // by the pixel at hand, in order
  std::vector<uint16_t> slots_;    // hash table: 1 + number of the source
  std::vector<float> colors_;      // channels_.size() for each source
};

}  // namespace pelage
