// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/job.h"
#include "base/stopwatch.h"
#include "render/frame/frame_statistics.h"
#include "render/frame/tile_pass.h"
#include "render/reflection/reflection_cache.h"

namespace pelage {

/// Fills a ReflectionCache for a frame. All threads trace paths of tiles of the whole picture, each tile into
/// a table of its own. The tables are added up in the order of the tiles, so the result does not depend on
/// threads.
class CacheFill {
 public:
  /// Reserves the memory that the cache may need while it is filled: an upper bound that depends only on the
  /// picture and the lights. Call before chunks take the rest of the memory. Throws Error (kMemory) when it
  /// does not fit.
  static MemoryCharge reserve(const RenderScene& scene, const Job& job);

  /// Keeps references to its arguments, except `options`. `splatted`: see CameraSamples.
  CacheFill(const RenderScene& scene, const Accel& accel, bool splatted, const PathOptions& options);

  /// Traces all paths and puts their light into `cache`. Leaves it empty when `job` was cancelled.
  /// `reserved`: the result of reserve().
  void run(MemoryCharge reserved, const Job& job, const Stopwatch& clock,
           std::optional<ReflectionCache>& cache);
  /// Returns the costs of all threads, and adds their counts to `statistics`.
  TileCosts costs() const;
  void add_to(FrameStatistics& statistics) const;

 private:
  PassEnd trace_batch(const std::vector<Tile>& batch, uint32_t round, const Job& job, const Stopwatch& clock,
                      ReflectionTable& sum);

  const RenderScene& scene_;
  const FrameShading shading_;
  const CameraSamples camera_;
  const ReflectionPaths paths_;
  std::vector<ReflectionPaths::Scratch> scratch_;  // by thread
  int64_t cells_ = 0;
};

}  // namespace pelage
