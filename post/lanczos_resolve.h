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

  /// Writes the colours of row `y`, for which `buffer` holds rows y - kReach to y + kReach as far as the
  /// picture has them, over the whole width of the picture, from column 0 on.
  void write_row(const WorkBuffer& buffer, int y);

 private:
  struct Run {
    int begin;  // sample; ends where the next one begins
    Sample sample;
  };
  struct Part {
    uint32_t source;
    float weight;
    bool is_near;  // seen within the 3 x 3 pixels around
  };
  /// A pixel whose parts have been gathered: parts_[first .. last), those before `near_last` near.
  struct Gathered {
    size_t first, near_last, last;
    float weight;  // of all samples that are within the picture
    bool near_hole;
  };

  void find_runs(const WorkBuffer& buffer, int y);
  Gathered gather(int x, int y, const PixelBox& samples);
  void add(uint32_t source, float weight, bool is_near);
  void find_offsets(const Plane& source);
  float resolve(const Gathered& pixel, const float* words) const;

  const PostLayers& layers_;
  int scale_, reach_;                   // samples per pixel; taps on each side of the pixel's first sample
  std::vector<double> weights_;         // by tap
  std::vector<double> sums_to_;         // of the weights before a tap
  std::vector<std::vector<Run>> runs_;  // by sample row, with one at the end that begins behind it
  std::vector<size_t> first_run_;       // of each row, for the pixel at hand
  int runs_row_ = 0;                    // sample row of runs_[0]
  std::vector<Part> pixel_;             // the parts of the pixel at hand
  // Pixels are gathered by the segment, so that each channel is fetched from a few rows at a time.
  static constexpr int kSegment = 128;
  std::vector<Gathered> pixels_;
  std::vector<uint32_t> sources_;
  std::vector<float> part_weights_;
  std::vector<ptrdiff_t> offsets_;  // of the sources, from a plane's first word
  std::vector<uint16_t> slots_;     // hash table: 1 + number of the part
};

}  // namespace pelage
