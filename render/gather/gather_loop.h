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
  /// Reserves memory for one tile per thread, before chunks take the rest. If this were more than an eighth
  /// of `render.memory`, it reserves memory for fewer tiles, and threads wait for each other. Throws Error
  /// (kMemory) when not even one tile fits.
  static Memory reserve_tiles(const RenderScene& scene, const Job& job);

  /// Keeps references to its arguments. Adds the samples to `result.film`. `clock`: starts with the time
  /// limit.
  GatherLoop(const RenderScene& scene, const Accel& accel, const PathOptions& options, const Memory& memory,
             const Job& job, const Stopwatch& clock, FrameResult& result);

  /// Renders the frame into `result`.
  void run();
  /// Of all threads.
  TileCosts costs() const;

 private:
  class Lease;
  struct Pass {
    uint32_t first = 0, count = 1;
    bool replaces = false;  ///< earlier samples
    bool scattered = false;
  };
  PassEnd trace(const Pass& pass, double deadline_s);
  /// Number of samples of the next pass that fit the time limit.
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
