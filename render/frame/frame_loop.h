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
#include "render/frame/frame_saver.h"
#include "render/frame/frame_statistics.h"
#include "render/frame/frame_window.h"
#include "render/frame/sample_integrator.h"
#include "render/frame/tile_order.h"
#include "render/frame/tile_pass.h"

namespace pelage {

/// Traces samples and adds them to a film, in passes over all tiles.
class FrameLoop {
 public:
  /// Returns how many samples a pixel should have. `given`: how many it has now. The thread that traces the
  /// pixel calls this again when the pixel has as many samples as the last result. The pixel is finished when
  /// the result is not greater than `given`.
  using Goal = std::function<uint32_t(size_t pixel, uint32_t given)>;

  /// `film`: stores the pixels window.film. `clock`: deadlines are in seconds on this clock. `saver`: stores
  /// the state of the frame during passes; may be null. The constructor restores the state that the saver
  /// has.
  FrameLoop(const SampleIntegrator& integrator, const Job& job, Film& film, const FrameWindow& window,
            const Stopwatch& clock, FrameSaver* saver = nullptr);

  int width() const { return film_.width(); }
  int height() const { return film_.height(); }
  /// Returns the count of pixels of the film, including those that are not traced.
  size_t pixel_count() const { return sample_counts_.size(); }
  /// Returns the count of pixels that are traced.
  size_t traced_count() const {
    return static_cast<size_t>(traced_.width()) * static_cast<size_t>(traced_.height());
  }
  const Film& film() const { return film_; }
  /// Returns the count of samples traced for a pixel of the film so far.
  uint32_t sample_count(size_t pixel) const { return sample_counts_[pixel]; }
  // Min and mean of sample_count() over the traced pixels.
  uint32_t min_samples() const;
  double mean_samples() const;

  /// Traces every pixel to its goal. Tiles follow the order of a Hilbert curve. With `scattered`, consecutive
  /// tiles are far apart instead, so that threads that start together do not wait for the same fur. One
  /// thread adds all samples of a pixel, in order. Starts no more tiles once the clock passes `deadline_s`.
  PassEnd pass(const Goal& goal, bool scattered, double deadline_s = std::numeric_limits<double>::infinity());
  /// Returns the state of the frame, for the saver. Call between passes.
  FrameState state();

  /// Returns the mean time per sample, in seconds of one thread, over all samples so far of the tile that
  /// contains the pixel; 0 if it has none.
  double cost(size_t pixel) const;
  /// Returns the seconds on the clock when the first tile of the first pass was finished.
  double first_tile_s() const { return first_tile_s_; }
  /// Returns the costs of the tiles so far, summed over all threads.
  TileCosts costs() const;
  /// Adds the counts of rays, of accelerator work and of rejected samples.
  void add_to(FrameStatistics& statistics) const;
  /// Returns the fraction of the indirect light that render.clamp_indirect removed.
  double clamped_fraction() const;

 private:
  struct TileCost {
    double seconds = 0, samples = 0;
  };
  /// Returns false when cancelled before the end of the tile.
  bool trace(const Tile& tile, const Goal& goal, SampleScratch& scratch);
  /// Adds samples to a pixel, at most `at_once`, until it has as many as `goal` says. Returns false when
  /// cancelled. `given`: count of its samples.
  bool trace_pixel(int x, int y, const Goal& goal, uint32_t at_once, uint32_t& given, SampleScratch& scratch);
  /// Returns the min sample count over the pixels of a tile.
  uint32_t min_samples(const Tile& tile) const;
  size_t tile_of(int x, int y) const;
  size_t pixel_of(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width()) + static_cast<size_t>(x);
  }

  const SampleIntegrator& integrator_;
  Job job_;
  Film& film_;
  const int left_, top_;   // pixel (0, 0) of the film, in the picture
  const PixelBox traced_;  // in pixels of the film, like all pixels of this class
  const Stopwatch& clock_;
  FrameSaver* saver_;
  std::vector<Tile> tiles_;
  std::vector<TileCost> costs_;                          // by tile, row by row
  std::vector<uint32_t> sample_counts_;                  // by pixel
  std::vector<std::unique_ptr<SampleScratch>> scratch_;  // one per worker
  std::atomic<int64_t> rejected_{0};
  std::atomic<double> first_tile_s_{0};
};

}  // namespace pelage
