// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/frame/frame_loop.h"
#include "render/scene/render_params.h"

namespace pelage {

/// How the schedule ended.
struct ScheduleEnd {
  bool partial = false;       ///< cancelled
  bool time_limited = false;  ///< the time limit determined the number of samples
};

/// Decides how many samples each pixel gets, and in which order. A frame that is cancelled or runs out of
/// time is valid; it has fewer samples.
///
/// Uniform: passes of 1, 1, 2, 4, 8 ... samples. Adaptive with the two-stage rule: such passes until each
/// pixel has a quarter of the pilot; the rest of the pilot for pixels where samples vary; then passes until
/// each pixel has an eighth, a quarter, half and all of the additional samples that two_stage_counts()
/// requires. Adaptive with the seed's rule: passes of one, two, four ... batches for the pixels that have not
/// converged. When the memory limit does not hold all chunks (`stays` is false) and there is no time limit,
/// each stage is a single pass, so that a tile is finished while its chunks are resident.
///
/// Every count is a function of the samples of the frame, independent of threads and the clock, unless the
/// time limit is reached. The limit counts from the start of `clock`; every pixel gets at least one sample.
/// Under the two-stage rule, counts are scaled down to fit the limit; the time per sample is estimated from
/// the pilot.
class SampleSchedule {
 public:
  SampleSchedule(FrameLoop& loop, const RenderParams& params, const Job& job, const Stopwatch& clock,
                 bool stays);
  ScheduleEnd run();

 private:
  using End = PassEnd;
  /// Traces all pixels to `samples`.
  End uniform(uint32_t samples);
  /// A quarter of the pilot for every pixel, and the rest of the pilot where needs_full_pilot() requires it.
  End pilot();
  End two_stage();
  End seed();
  /// The counts of two_stage_counts(), scaled to fit the time limit.
  std::vector<uint32_t> second_stage_counts();
  uint32_t max_samples() const { return static_cast<uint32_t>(params_.samples); }
  double deadline() const;

  FrameLoop& loop_;
  const RenderParams& params_;
  Job job_;
  const Stopwatch& clock_;
  bool in_passes_;
  bool cut_ = false;  // counts were scaled down to fit the time limit
};

}  // namespace pelage
