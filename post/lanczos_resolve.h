// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "post/layers.h"
#include "post/work_buffer.h"

namespace pelage {

/// Converts a work buffer to pixels with a Lanczos-windowed sinc of three lobes, whose negative lobes keep
/// the picture sharp [Neulander13]: L(t) = sinc(t) sinc(t / 3) for |t| < 3 pixels, separable. Ringing is
/// clamped to the min and max of the surrounding 3 x 3 pixels. Samples outside of the picture are ignored;
/// holes inside count as zero. Data comes from the front-most sample within the pixel; mattes are averaged by
/// BoxResolve.
///
/// Thread safety: one thread at a time; use one per worker.
class LanczosResolve {
 public:
  /// Radius of the filter beyond the central pixel.
  static constexpr int kReach = 3;

  LanczosResolve(const PostLayers& layers, int scale);

  /// Memory needed for rows of this width, unless source pixels are scattered over the whole picture.
  static size_t bytes_needed(int width, size_t channels, int scale);

  /// Writes the colours of row `y` over the whole width of the picture, from column 0 on. `buffer` must
  /// contain rows y - kReach to y + kReach, clipped to the picture.
  void write_row(const WorkBuffer& buffer, int y);

 private:
  struct Run {
    int begin;  // first sample; ends where the next one begins
    Sample sample;
  };
  struct Part {
    uint32_t source;  // number in sources_
    float weight;
  };
  /// A gathered pixel: its parts are parts_[first .. last); those before `near_last` are visible within the
  /// surrounding 3 x 3 pixels.
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

  int scale_, reach_;                   // samples per pixel; taps on each side of the pixel's first sample
  std::vector<double> weights_;         // by tap
  std::vector<double> sums_to_;         // of the weights before a tap
  std::vector<std::vector<Run>> runs_;  // by sample row, with a sentinel at the end
  std::vector<size_t> first_run_;       // of each row, for the current pixel
  int runs_row_ = 0;                    // sample row of runs_[0]

  // Pixels are gathered in segments, and the colours of their sources are stored contiguously, so that sums
  // run over whole groups of channels.
  static constexpr size_t kLanes = 16, kLongestSegment = 128, kEnoughSources = 1 << 12;
  std::vector<PostChannel> channels_;  // colours, the last one repeated to fill the lanes
  size_t color_count_ = 0;
  std::vector<Gathered> pixels_;
  std::vector<Part> parts_;
  std::vector<uint32_t> sources_;  // distinct pixels
  std::vector<Share> shares_;      // by source
  std::vector<uint32_t> met_;      // of the current pixel, in order
  std::vector<uint16_t> slots_;    // hash table: 1 + number of the source
  std::vector<float> colors_;      // channels_.size() for each source
};

}  // namespace pelage
