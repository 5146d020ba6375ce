// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "base/job.h"
#include "base/stopwatch.h"
#include "render/frame/tile_order.h"

namespace pelage {

/// How a pass over the tiles ended.
enum class PassEnd {
  kDone,
  kCancelled,
  kOutOfTime,
  kInterrupted,  ///< by FrameLoop::Pass::interrupts
};

/// Calls `trace(tile, worker)` for each tile, on all threads. The threads take the tiles in the given order.
/// Calls are made inside a FlushDenormals scope. Stops early and returns kCancelled when the job is cancelled
/// or `trace` returns false. Starts no more tiles once `clock` passes `deadline_s`, and then returns
/// kOutOfTime. Otherwise returns kDone.
PassEnd trace_tiles(const std::vector<Tile>& tiles, const Job& job, const Stopwatch& clock, double deadline_s,
                    const std::function<bool(const Tile& tile, int worker)>& trace);

}  // namespace pelage
