// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/frame/frame_loop.h"
#include "render/scene/render_params.h"

namespace pelage {

/// How it ended.
struct ScheduleEnd {
  bool partial = false;       ///< cancelled
  bool time_limited = false;  ///< the clock decided how many samples there are
};

/// Decides which pixel gets how many samples, and in which order, so that a frame that is cancelled, or out
/// of time, is a valid one of fewer samples.
///
/// All pixels alike: passes of 1, 1, 2, 4, 8 ... samples. Adaptive, two-stage: such passes until each has a
/// quarter of the pilot, the rest of it where anything varies, then an eighth, a quarter, half and all of
/// what two_stage_counts() says is missing. Adaptive by the seed's rule: passes of one batch, two, four ...
/// for the pixels that have not converged. Where the memory limit does not hold all chunks (`stays` is false)
/// and no time limit is set, stages are one pass each, so that a tile is finished while what it needs is
/// there.
///
/// Every count is a function of the samples of the frame, not of threads or of the clock, unless the time
/// limit is met. The limit counts from the start of `clock`; every pixel gets one sample at least. Under the
/// two-stage rule counts shrink in proportion until, by what the pilot took, all of them fit.
class SampleSchedule {
 public:
  SampleSchedule(FrameLoop& loop, const RenderParams& params, const Job& job, const Stopwatch& clock,
                 bool stays);
  ScheduleEnd run();

 private:
  using End = FrameLoop::End;
  /// All pixels to `samples`.
  End uniform(uint32_t samples);
  /// A quarter of the pilot for every pixel, and the rest where needs_full_pilot() says so.
  End pilot();
  End two_stage();
  End seed();
  /// What two_stage_counts() asks for, as counts that fit the time limit.
  std::vector<uint32_t> second_stage_counts();
  uint32_t max_samples() const { return static_cast<uint32_t>(params_.samples); }
  double deadline() const;

  FrameLoop& loop_;
  const RenderParams& params_;
  Job job_;
  const Stopwatch& clock_;
  bool in_passes_;
  bool cut_ = false;  // counts were shrunk to fit the time limit
};

}  // namespace pelage
