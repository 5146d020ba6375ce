// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "base/job.h"
#include "base/stopwatch.h"
#include "render/frame/frame_statistics.h"
#include "render/frame/tile_pass.h"
#include "render/reflection/cache_plan.h"
#include "render/reflection/reflection_cache.h"
#include "render/reflection/reflection_paths.h"

namespace pelage {

/// Fills a ReflectionCache for a frame. All threads trace paths of tiles of the whole picture, each tile into
/// a table of its own. The tables are added up in the order of the tiles. Where memory is short, the cells
/// are filled slice by slice. For each slice, all paths are traced again, but only those that reach a cell of
/// the slice are followed to their ends. The sums of a cell are the same, so the result depends neither on
/// threads nor on slices.
class CacheFill {
 public:
  /// The memory that the cache may need while it is filled.
  struct Memory {
    CachePlan plan;
    MemoryCharge charge;
  };
  /// Reserves memory for the plan that fits. Call before chunks take the rest of the memory. Throws Error
  /// (kMemory) when not even the smallest plan fits.
  static Memory reserve(const FrameScene& scene, const Job& job);

  /// Keeps references to its arguments, except `options`. `splatted`: see CameraSamples.
  CacheFill(const FrameScene& scene, const Accel& accel, bool splatted, const PathOptions& options,
            Memory memory);

  /// Traces all paths and puts their light into `cache`. Leaves it empty when `job` was cancelled. Call once.
  void run(const Job& job, const Stopwatch& clock, std::optional<ReflectionCache>& cache);
  /// Returns the costs of all threads, and adds their counts to `statistics`.
  TileCosts costs() const;
  void add_to(FrameStatistics& statistics) const;

 private:
  enum class SliceEnd { kDone, kCancelled, kTooLarge };

  SliceEnd fill_slice(const CellRange& range, const Job& job, const Stopwatch& clock, ReflectionTable& sum);
  PassEnd trace_batch(const std::vector<Tile>& batch, const ReflectionPaths::Share& share, double end_s,
                      const Job& job, const Stopwatch& clock, ReflectionTable& sum);
  void show(double part, const Job& job);
  void drop_cells(ReflectionTable& sum);
  void finish_slice(const CellRange& range, ReflectionTable sum);

  const FrameScene scene_;
  const FrameShading shading_;
  const CameraSamples camera_;
  const ReflectionPaths paths_;
  Memory memory_;
  std::vector<Tile> tiles_;
  std::vector<ReflectionPaths::Scratch> scratch_;  // by thread
  double start_s_ = 0, shown_ = 0;                 // when filling began; part of the work shown as done
  // The finished slices:
  std::optional<ReflectionSlots> slots_;
  std::array<size_t, std::tuple_size_v<CellPath>> cells_{};  // by level, those with few paths included
  uint32_t smallest_ = 0;                                    // no cells below this level are kept
  ReflectionStatistics counts_;
};

}  // namespace pelage
