// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "base/job.h"
#include "render/film/film.h"
#include "render/frame/frame_saver.h"
#include "render/frame/sample_scratch.h"
#include "render/frame/tile_order.h"

namespace pelage {

/// Returns how many samples a pixel of the film should have. May be called from any thread.
using SampleGoal = std::function<uint32_t(size_t pixel)>;

/// What the tasks of a pass have in common.
struct TaskFrame {
  Film& film;
  int left = 0, top = 0;  ///< pixel (0, 0) of the film, in the picture
  const SampleGoal& goal;
  const Job& job;
  const FrameSaver* saver;                  ///< null: none
  const std::function<bool()>& interrupts;  ///< whether the pass should end early; empty: never
  /// Receives counts of samples that were added to a tile.
  std::function<void(const Tile& tile, uint64_t samples)> advance;
};

/// A tile of a film, and how many samples its pixels should have.
class TileTask {
 public:
  /// `pixels`: the tile, in pixels of the film.
  TileTask(const TaskFrame& frame, const Tile& pixels) : tile(pixels), frame_(frame) {}

  const Tile tile;
  Film& film() const { return frame_.film; }
  const Job& job() const { return frame_.job; }
  int left() const { return frame_.left; }
  int top() const { return frame_.top; }
  uint32_t goal(int x, int y) const {
    return frame_.goal(static_cast<size_t>(y) * static_cast<size_t>(frame_.film.width()) +
                       static_cast<size_t>(x));
  }
  /// Returns whether the thread should stop: the job is cancelled, the pass ends early, or the state of the
  /// frame should be saved.
  bool must_stop() const {
    return frame_.job.progress.cancelled() || (frame_.saver && frame_.saver->due()) ||
           (frame_.interrupts && frame_.interrupts());
  }
  /// Adds the sample in `scratch` to a pixel of the film. Returns false if it was rejected.
  bool add(int x, int y, SampleScratch& scratch) const {
    const bool added = frame_.film.add(x, y, scratch.sample, scratch.by_layer);
    if (!added) ++scratch.rejected;
    return added;
  }
  /// Call after samples were added.
  void advance(uint64_t samples) const {
    if (samples > 0) frame_.advance(tile, samples);
  }

 private:
  const TaskFrame& frame_;
};

/// Interface of integrators; FrameLoop calls them. Thread safety: const members may be called from any
/// thread, each with its own scratch.
class TileIntegrator {
 public:
  virtual ~TileIntegrator() = default;
  virtual std::unique_ptr<SampleScratch> make_scratch() const = 0;
  /// Returns how many tiles may be traced at the same time, each with a scratch of its own.
  virtual int max_tiles(int threads) const { return threads; }
  /// Returns whether the samples of a tile share light. If so, all pixels of a tile always have the same
  /// goal, and tiles are not cut off at the border of a region.
  virtual bool shares_light() const { return false; }
  /// Returns how many of the samples first .. end - 1 of each pixel of a tile must be taken together.
  virtual uint32_t together(uint32_t /*first*/, uint32_t /*end*/) const { return 1; }
  /// Adds samples to the pixels of a tile until each has as many as its goal. The samples depend only on the
  /// scene, the place of the tile in the picture and the indices of the samples in their pixels. Returns
  /// false if the task had to stop before. `scratch`: from make_scratch().
  virtual bool trace_tile(const TileTask& task, SampleScratch& scratch) const = 0;
};

/// An integrator that computes one sample of a pixel at a time. A sample depends only on the scene, the pixel
/// and the index of the sample in its pixel.
class SampleIntegrator : public TileIntegrator {
 public:
  /// Computes sample `sample` of pixel (x, y) of the picture, and stores it in `scratch`.
  virtual void trace(int x, int y, uint32_t sample, SampleScratch& scratch) const = 0;
  bool trace_tile(const TileTask& task, SampleScratch& scratch) const final;

 private:
  bool trace_pixel(const TileTask& task, int x, int y, uint32_t goal, SampleScratch& scratch) const;
};

}  // namespace pelage
