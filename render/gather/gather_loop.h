// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <semaphore>
#include <vector>

#include "base/job.h"
#include "base/ledger.h"
#include "base/stopwatch.h"
#include "render/frame/frame_result.h"
#include "render/frame/tile_pass.h"
#include "render/gather/gather_tile.h"

namespace pelage {

/// Renders a frame with GatherTile.
///
/// The first pass gives every pixel one sample, so that a frame that is cancelled or runs out of time is
/// valid. The second pass replaces this sample, tile by tile, by up to GatherTile::max_samples() samples;
/// further passes add more. The picture does not depend on the number of threads, and only a frame that ends
/// early shows the first pass.
class GatherLoop {
 public:
  /// Memory of the tiles that are traced at once.
  struct Memory {
    int tiles = 0;
    MemoryCharge charge;
  };
  /// Reserves memory before chunks take the rest: for one tile per thread, or fewer where these would take
  /// more than an eighth of `render.memory`; then threads wait for each other. Throws Error (kMemory) when
  /// not even one fits.
  static Memory reserve_tiles(const RenderScene& scene, const Job& job);

  /// References are kept. `chunks`: those of `accel`. `result.film` gets the samples. `clock`: starts when
  /// the time limit does.
  GatherLoop(const RenderScene& scene, const Accel& accel, const ResidentChunks& chunks,
             const PathOptions& options, const Memory& memory, const Job& job, const Stopwatch& clock,
             FrameResult& result);

  /// Renders the frame into `result`.
  void run();

 private:
  class Lease;
  struct Pass {
    uint32_t first = 0, count = 1;
    bool replaces = false;  ///< earlier samples
    bool scattered = false;
  };
  PassEnd trace(const Pass& pass, double deadline_s);
  /// Samples of the next pass that fit the time limit; 0: none.
  uint32_t fitting(uint32_t count, uint32_t given) const;
  bool trace_tile(const Pass& pass, const Tile& tile, int worker);
  void land(const Pass& pass, const Tile& tile, GatherTile::Scratch& scratch);
  void report(PassEnd end);

  const RenderScene& scene_;
  const GatherTile tile_;
  const Job job_;
  const Stopwatch& clock_;
  FrameResult& result_;
  std::vector<Tile> tiles_;
  std::vector<std::unique_ptr<GatherTile::Scratch>> scratch_;
  std::counting_semaphore<> free_;  // number of `idle_`
  std::mutex idle_mutex_;
  std::vector<GatherTile::Scratch*> idle_;  // of scratch_
  std::atomic<int64_t> rejected_{0};
  std::atomic<double> first_tile_s_{0};
  double sample_s_ = 0;  // wall seconds of one sample per pixel in the last pass
};

}  // namespace pelage
