// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "base/job.h"
#include "base/stopwatch.h"
#include "render/film/film.h"
#include "render/frame/frame_statistics.h"
#include "render/frame/sample_integrator.h"
#include "render/frame/tile_order.h"
#include "render/frame/tile_pass.h"

namespace pelage {

/// Traces passes of samples over a film, tile by tile.
class FrameLoop {
 public:
  /// The number of samples that a pixel with `given` samples should have. The thread that traces the pixel
  /// calls this repeatedly, until the pixel has that number.
  using Goal = std::function<uint32_t(size_t pixel, uint32_t given)>;

  /// `clock`: deadlines are times on this clock.
  FrameLoop(const SampleIntegrator& integrator, const Job& job, Film& film, const Stopwatch& clock);

  int width() const { return film_.width(); }
  int height() const { return film_.height(); }
  size_t pixel_count() const { return sample_counts_.size(); }
  const Film& film() const { return film_; }
  /// Number of samples traced for a pixel.
  uint32_t sample_count(size_t pixel) const { return sample_counts_[pixel]; }
  uint32_t min_samples() const;
  double mean_samples() const;

  /// Traces every pixel to its goal: in the order of a Hilbert curve or, when `scattered`, with consecutive
  /// tiles far apart, so that threads that start together do not wait for the same fur. Samples of one pixel
  /// are added in order by one thread. Starts no more tiles once the clock passes `deadline_s`.
  PassEnd pass(const Goal& goal, bool scattered, double deadline_s = std::numeric_limits<double>::infinity());

  /// Mean thread seconds per sample of the pixel's tile so far.
  double cost(size_t pixel) const;
  /// Time on the clock when the first tile was finished.
  double first_tile_s() const { return first_tile_s_; }
  /// Of all threads.
  TileCosts costs() const;
  void add_to(FrameStatistics& statistics) const;
  /// Fraction of the indirect light that render.clamp_indirect removed.
  double clamped_fraction() const;

 private:
  struct TileCost {
    double seconds = 0, samples = 0;
  };
  /// False when it was cancelled before the end.
  bool trace(const Tile& tile, const Goal& goal, SampleScratch& scratch);
  bool trace_pixel(int x, int y, const Goal& goal, uint32_t& given, SampleScratch& scratch);
  size_t tile_of(int x, int y) const;

  const SampleIntegrator& integrator_;
  Job job_;
  Film& film_;
  const Stopwatch& clock_;
  std::vector<Tile> tiles_;
  std::vector<TileCost> costs_;                          // of tiles row by row
  std::vector<uint32_t> sample_counts_;                  // by pixel
  std::vector<std::unique_ptr<SampleScratch>> scratch_;  // one per worker
  std::atomic<int64_t> rejected_{0};
  std::atomic<double> first_tile_s_{0};
};

}  // namespace pelage
