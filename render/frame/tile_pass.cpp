// SPDX-License-Identifier: Apache-2.0
#include "render/frame/tile_pass.h"

#include <atomic>

#include "base/parallel.h"
#include "render/accel/flush_denormals.h"

namespace pelage {

PassEnd trace_tiles(const std::vector<Tile>& tiles, const Job& job, const Stopwatch& clock, double deadline_s,
                    const std::function<bool(const Tile&, int)>& trace) {
  std::atomic<bool> cancelled{false}, out_of_time{false};
  job.workers.for_each(tiles.size(), 1, [&](WorkRange range) {
    const FlushDenormals flush;
    for (size_t i = range.begin; i < range.end; ++i) {
      if (clock.seconds() > deadline_s) out_of_time = true;
      if (out_of_time) return;
      // Other threads end before their next tile, too.
      if (cancelled || job.progress.cancelled() || !trace(tiles[i], range.worker)) {
        cancelled = true;
        return;
      }
    }
  });
  if (cancelled) return PassEnd::kCancelled;
  return out_of_time ? PassEnd::kOutOfTime : PassEnd::kDone;
}

}  // namespace pelage
