// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "base/job.h"
#include "base/stopwatch.h"
#include "render/film/film.h"
#include "render/frame/frame_result.h"
#include "render/frame/frame_saver.h"
#include "render/frame/frame_window.h"
#include "render/frame/scratch_pool.h"
#include "render/frame/tile_integrator.h"
#include "render/frame/tile_pass.h"

namespace pelage {

/// The loop over the tiles of a frame, for all integrators. Threads take tiles, and the integrator adds their
/// samples to the film. The film counts the samples of each pixel, so it is the whole state of the loop.
/// SamplePasses decides which passes are made.
///
/// One thread adds all samples of a tile in a pass, and always in the same order. So the film depends neither
/// on threads nor on passes.
class FrameLoop {
 public:
  /// `film`: stores the pixels window.film. `clock`: deadlines are in seconds on this clock. `saver`: stores
  /// the state of the frame during passes; may be null. The constructor restores the state that the saver
  /// has. Keeps references to its arguments.
  FrameLoop(const TileIntegrator& integrator, const Job& job, Film& film, const FrameWindow& window,
            const Stopwatch& clock, FrameSaver* saver = nullptr);

  const Film& film() const { return film_; }
  /// Returns the pixels of the film that are traced.
  const PixelBox& traced() const { return traced_; }
  /// Returns their count.
  double traced_count() const { return 1.0 * traced_.width() * traced_.height(); }
  // Min and mean of the sample counts over the traced pixels.
  uint32_t min_samples() const { return film_.min_samples(traced_); }
  double mean_samples() const { return film_.sample_sum(traced_) / traced_count(); }
  /// Returns whether the order of samples links the pixels of a tile: they share light, or splatted samples
  /// enter the same sum. Then all pixels of a tile must get the same goals, and a region of a pass consists
  /// of whole tiles.
  bool links_pixels() const { return integrator_.shares_light() || film_.layers().splat.has_value(); }
  /// Returns the least count of samples per pixel, from `wanted` up to `max`, where a pass may end that
  /// begins with `given` samples.
  uint32_t pass_end(uint32_t given, uint32_t wanted, uint32_t max) const;

  /// A pass over the tiles.
  struct Pass {
    SampleGoal goal;
    std::optional<PixelBox> region = {};  ///< the only pixels to trace, see links_pixels(); empty: all
    /// Tiles follow the order of a Hilbert curve. With `scattered`, consecutive tiles are far apart instead,
    /// so that threads that start together do not wait for the same fur.
    bool scattered = false;
    double deadline_s = std::numeric_limits<double>::infinity();  ///< no tile starts later
    std::function<bool()> interrupts = {};  ///< whether the pass should end early; from any thread
  };
  PassEnd pass(const Pass& pass);
  /// Returns the state of the frame, for the saver. Call between passes.
  FrameState state() { return film_.state(); }

  /// Returns the mean time per sample, in seconds of one thread, over all samples so far of the tile that
  /// contains the pixel; 0 if it has none.
  double cost(size_t pixel) const;
  /// Returns the costs of the tiles so far, summed over all threads.
  TileCosts costs() const;
  /// Adds the counts of all threads.
  void add_to(FrameStatistics& statistics) const;
  /// Stores figures about the samples of the film, and adds the counts of all threads.
  void report(FrameResult& result) const;

 private:
  struct TileCost {
    double seconds = 0, samples = 0;
  };
  /// Returns the tiles of a pass, in the order of a Hilbert curve.
  std::vector<Tile> tiles(const std::optional<PixelBox>& region) const;
  /// Sets the weights of the tiles of a pass: the costs of their samples in earlier passes, relative to the
  /// mean over all samples of the pass. All are 1 while one of the costs is unknown.
  void weigh(const std::vector<Tile>& tiles, const SampleGoal& goal);
  /// Returns false if the tile is not finished.
  bool trace(const TileTask& task, int worker);
  void advance(const Tile& tile, uint64_t samples);
  size_t tile_index(int x, int y) const;

  const TileIntegrator& integrator_;
  const Job job_;
  Film& film_;
  const int left_, top_;   // pixel (0, 0) of the film, in the picture
  const PixelBox traced_;  // in pixels of the film, like all pixels of this class
  const Stopwatch& clock_;
  FrameSaver* const saver_;
  std::vector<TileCost> tile_costs_;  // by tile of the film, row by row
  std::vector<double> weights_;  // of samples in the progress, by tile of the film; so that the progress is
                                 // even although fur costs more than background
  ScratchPool scratch_;
  std::atomic<double> first_tile_s_{0};
};

}  // namespace pelage
