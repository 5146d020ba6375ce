// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "render/frame/frame_loop.h"
#include "render/frame/frame_watch.h"
#include "render/scene/render_params.h"

namespace pelage {

/// Decides how many samples each pixel gets, and in which order. A frame that is cancelled or runs out of
/// time is valid, but has fewer samples.
///
/// Passes:
/// - Without adaptive sampling, each pass takes as many samples of every pixel as all passes before it
///   together: 1, 1, 2, 4, 8 ... With `gather`, more where samples must be taken together.
/// - With adaptive sampling, such passes first take a quarter of the pilot. One pass
///   takes the rest of the pilot in those pixels that need it (needs_full_pilot()). Then two_stage_counts()
///   determines how many samples each pixel needs. Four passes take the missing samples: up to an eighth, a
///   quarter, a half, and all of them. If samples link the pixels of a tile (FrameLoop::links_pixels()), the
///   rule of tiles decides instead, from half of the pilot.
///
/// Several passes give an early preview of the whole picture. But when `fits` is false and there is no time
/// limit, each stage is a single pass instead, so that a tile is finished while its chunks are in memory.
/// With a watch, there are more passes, see FrameWatch.
///
/// Unless the time limit reduces the counts, every count depends only on the samples of the frame, not on
/// threads or the clock. The time limit starts with `clock`. Every pixel gets at least one sample, even if
/// that takes longer. Adaptive sampling estimates the time per sample from the pilot, and scales its counts
/// down to fit the limit.
class SamplePasses {
 public:
  /// `fits`: whether all chunks together fit `render.memory`, so that none is evicted. `watch`: may be null.
  SamplePasses(FrameLoop& loop, const RenderParams& params, const Job& job, const Stopwatch& clock, bool fits,
               FrameWatch* watch = nullptr);

  /// Returns the memory, in bytes, that adaptive sampling needs in a picture of so many pixels.
  static int64_t bytes_needed(const RenderParams& params, int64_t pixels);

  /// How the passes ended.
  struct End {
    bool partial = false;       ///< cancelled
    bool time_limited = false;  ///< the time limit determined the number of samples
  };
  /// Takes all samples of the frame.
  End run();
  /// Takes only the first samples of the pixels on grids of 8, 4 and 2 pixels, for a watch that sees them as
  /// PassState::coarse. Returns false when cancelled.
  bool run_coarse();

 private:
  /// Makes one pass and tells the watch, unless the pass is cancelled. `grid`: see PassState. A new region of
  /// the watch interrupts the pass, which then continues after refine_region(). So does a pause.
  PassEnd pass(const SampleGoal& goal, bool scattered, double deadline_s, int grid = 1);
  /// Takes the samples of the region that the watch has chosen: all of them, or those of the pass with this
  /// goal.
  PassEnd refine_region(const SampleGoal& goal, double deadline_s);
  PassState state() const;
  void tell_watch();
  /// Takes the first sample of the pixels on grids of 8, 4 and 2 pixels.
  PassEnd coarse_passes();
  /// Takes samples until every pixel has `samples`.
  PassEnd uniform(uint32_t samples);
  /// Takes a part of the pilot in every pixel, and the rest of the pilot where it is needed.
  PassEnd pilot();
  PassEnd two_stage();
  /// Returns the counts of the rule, rounded and scaled down to fit the time limit. `before`: the
  /// counts so far, by pixel.
  std::vector<uint32_t> second_stage_counts(const std::vector<uint32_t>& before);
  uint32_t max_samples() const { return static_cast<uint32_t>(params_.samples); }
  double deadline() const;

  FrameLoop& loop_;
  const RenderParams& params_;
  const Job job_;
  const Stopwatch& clock_;
  FrameWatch* const watch_;
  const bool in_passes_;                    // whether a stage has several passes
  const std::function<bool()> interrupts_;  // whether the watch has a new region or asks for a pause; empty
                                            // without a watch
  uint32_t region_seen_ = 0;     // version of the watch's region that the current pass takes into account
  uint32_t region_refined_ = 0;  // version of the region that refine_region() has finished
  uint32_t pause_seen_ = 0;      // version of the watch's last pause
  int grid_ = 0;                 // PassState::grid of the last pass over the whole picture; 0: none so far
  bool coarse_ = false;          // see PassState
  PixelBox full_;                // see PassState
  bool cut_ = false;             // counts were scaled down to fit the time limit
};

}  // namespace pelage
