// SPDX-License-Identifier: Apache-2.0
#include "render/path/frame_geometry.h"

#include <algorithm>

#include "base/parallel.h"
#include "base/stopwatch.h"

namespace pelage {

FrameGeometry::FrameGeometry(std::unique_ptr<const FrameChunks> chunks, std::vector<ChunkBounds> bounds,
                             const ChunkAccelOptions& options, const Workers& workers, Progress& progress,
                             MemoryLedger& ledger)
    : chunks_(std::move(chunks)), accel_(std::move(bounds), *chunks_, options, ledger, workers, progress) {}

std::unique_ptr<const FrameGeometry> FrameGeometry::make(const RenderScene& scene, const Workers& workers,
                                                         Progress& progress, MemoryLedger& ledger,
                                                         Statistics& statistics) {
  auto chunks = std::make_unique<const FrameChunks>(scene, workers);
  const Stopwatch bounding;
  std::vector<ChunkBounds> bounds = chunks->bounds(workers, progress, ledger);
  statistics.stages_s["bound"] += bounding.seconds();
  if (progress.cancelled()) return nullptr;
  statistics.chunks += static_cast<int64_t>(chunks->size());

  ChunkAccelOptions options;
  options.chunk.shape = scene.render.curves;
  options.chunk.compact_attributes = scene.render.compact_attributes;
  options.eager = scene.render.bounds == BoundingStrategy::kNone;
  options.memory_limit = scene.render.memory.bytes;
  options.threads = workers.thread_count();
  options.opaque = chunks->opaque();
  const Stopwatch growing;
  std::unique_ptr<const FrameGeometry> geometry(
      new FrameGeometry(std::move(chunks), std::move(bounds), options, workers, progress, ledger));
  if (options.eager) statistics.stages_s["grow"] += growing.seconds();
  return progress.cancelled() ? nullptr : std::move(geometry);
}

void FrameGeometry::add_to(Statistics& statistics) const {
  const ResidencyCounts counts = accel_.counts();
  statistics.strands_generated += chunks_->strands_grown();
  statistics.bounds_area += accel_.bounds_area();
  statistics.chunks_touched += counts.touched;
  statistics.expansions += counts.expansions;
  statistics.reexpansions += counts.reexpansions;
  statistics.false_expansions += counts.false_expansions;
  statistics.evictions += counts.evictions;
  statistics.residency_wait_s += counts.waited_s;
  statistics.working_set_bytes = std::max(statistics.working_set_bytes, counts.working_set_bytes);
}

}  // namespace pelage
