// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "base/job.h"
#include "base/stopwatch.h"
#include "render/frame/tile_order.h"

namespace pelage {

enum class PassEnd { kDone, kCancelled, kOutOfTime };

/// Calls `trace(tile, worker)` for the tiles in order, on all threads, each inside a FlushDenormals scope.
/// Ends early when the user asks to stop or `trace` returns false (kCancelled), and starts no more tiles once
/// `clock` passes `deadline_s` (kOutOfTime).
PassEnd trace_tiles(const std::vector<Tile>& tiles, const Job& job, const Stopwatch& clock, double deadline_s,
                    const std::function<bool(const Tile& tile, int worker)>& trace);

}  // namespace pelage
