// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <semaphore>
#include <vector>

#include "base/job.h"
#include "base/ledger.h"
#include "base/stopwatch.h"
#include "render/frame/frame_result.h"
#include "render/frame/frame_saver.h"
#include "render/frame/frame_watch.h"
#include "render/frame/tile_pass.h"
#include "render/gather/gather_tile.h"
#include "render/reflection/cache_fill.h"

namespace pelage {

/// Renders a frame with GatherTile, in passes over all tiles.
///
/// A first pass takes one sample of every pixel, so that a frame that is cancelled or runs out of time is
/// valid. (A frame with very few samples and no time limit has no such pass.) Each further pass adds up to
/// GatherTile::max_samples() samples per pixel. If the chunks do not all fit into memory and there is no time
/// limit, there is only one pass, which takes all samples of a tile, in the same portions, before the next
/// tile: more passes would grow chunks again. The picture depends neither on the number of threads nor on
/// the number of passes.
class GatherLoop {
 public:
  /// Memory of the tiles that are traced at the same time.
  struct Memory {
    int tiles = 0;  ///< max count of such tiles
    MemoryCharge charge;
    std::optional<CacheFill::Memory> cache;  ///< of the reflection cache
  };
  /// Reserves memory for one tile per thread. Call before chunks take the rest of the memory. If the tiles of
  /// all threads together would need more than an eighth of `render.memory`, reserves memory for fewer tiles,
  /// but for at least one. Threads then wait for each other. Throws Error (kMemory) when not even one tile
  /// fits.
  static Memory reserve_tiles(const RenderScene& scene, const Job& job);

  /// Keeps references to its arguments, except `options` and `memory`. `chunks`: the chunks of `accel`.
  /// `fits`: whether all chunks fit into memory together. `clock`: the time limit starts with it. `watch`:
  /// sees the film after each pass; may be null. `saver`: stores the state of the frame; may be null. The
  /// constructor restores the state that it has.
  GatherLoop(const RenderScene& scene, const Accel& accel, const ResidentChunks& chunks,
             const PathOptions& options, Memory& memory, bool fits, const Job& job, const Stopwatch& clock,
             FrameResult& result, FrameWatch* watch = nullptr, FrameSaver* saver = nullptr);

  /// Adds the samples of the frame to `result.film`, and stores counts and times in `result`.
  void run();
  /// Of all threads.
  TileCosts costs() const;

 private:
  class Lease;
  struct Pass {
    uint32_t first = 0, count = 1;  ///< samples first .. first + count - 1 of each pixel
    bool scattered = false;         ///< whether consecutive tiles are far apart
  };
  PassEnd trace(const Pass& pass, const std::vector<Tile>& tiles, double deadline_s);
  /// Makes a pass over all tiles. If the watch has a new region, refines its tiles first. A new region
  /// interrupts the pass, which then continues.
  PassEnd pass(const Pass& pass, double deadline_s);
  /// Takes all samples of the tiles of the watch's region, unless no tile has samples yet.
  PassEnd refine_region();
  /// Returns whether the watch still has the region that refine_region() has seen.
  bool is_current() const { return !refines_ || watch_->region_version() == region_seen_; }
  void tell_watch() const;
  FrameState state();
  size_t tile_of(const Tile& tile) const;
  /// Returns how many samples per pixel the next pass can take within the time limit: at most `count`.
  /// `given`: samples per pixel so far.
  uint32_t fitting(uint32_t count, uint32_t given) const;
  bool trace_tile(const Pass& pass, const Tile& tile, int worker);
  /// Returns how many of the samples first .. end - 1 share light with sample `first`.
  uint32_t portion(uint32_t first, uint32_t end) const;
  /// Returns the samples per pixel that a tile has so far.
  uint32_t& given(const Tile& tile) { return sample_counts_[tile_of(tile)]; }
  void land(uint32_t count, const Tile& tile, GatherTile::Scratch& scratch);
  void report(PassEnd end);

  const RenderScene& scene_;
  std::optional<CacheFill> fill_;  // empty: no reflection cache
  std::optional<ReflectionCache> cache_;
  const GatherTile tile_;
  const Job job_;
  const Stopwatch& clock_;
  FrameResult& result_;
  FrameWatch* const watch_;
  FrameSaver* const saver_;
  const bool in_passes_;    // otherwise, a tile gets all its samples before the next tile
  const bool first_alone_;  // whether the first sample of a pixel shares no light with further samples
  const bool refines_;      // whether the watch may choose a region
  std::vector<Tile> tiles_;
  std::vector<uint32_t> sample_counts_;  // given(), by tile, row by row
  uint32_t region_seen_ = 0;  // version of the watch's region that the current pass takes into account
  PixelBox full_;             // see PassState
  std::vector<std::unique_ptr<GatherTile::Scratch>> scratch_;
  std::counting_semaphore<> free_;  // its count is the size of idle_
  std::mutex idle_mutex_;
  std::vector<GatherTile::Scratch*> idle_;  // elements of scratch_ that no thread uses now
  std::atomic<int64_t> rejected_{0};
  std::atomic<double> first_tile_s_{0};
  double sample_s_ = 0;  // wall-clock seconds of the last pass / its samples per pixel
};

}  // namespace pelage
