// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/path/path_integrator_test.cpp.
#include "render/frame/frame_geometry.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "render/frame/stored_fur.h"

namespace pelage {

FrameGeometry::FrameGeometry(std::unique_ptr<const FrameChunks> chunks, std::vector<ChunkBounds> bounds,
                             const ResidentChunksOptions& options, const Job& job)
    : chunks_(std::move(chunks)),
      chunks_charge_(job.ledger, MemoryTag::kChunks, static_cast<int64_t>(chunks_->bytes())),
      stored_(options.file),
      stored_charge_(job.ledger, MemoryTag::kChunks,
                     options.file ? static_cast<int64_t>(options.file->bytes()) : 0),
      accel_(std::move(bounds), *chunks_, options, job) {}

std::unique_ptr<const FrameGeometry> FrameGeometry::make(const RenderScene& scene, const Job& job,
                                                         FrameStatistics& statistics) try {
  const Stopwatch preparing;
  auto chunks = std::make_unique<const FrameChunks>(scene, job);
  const Stopwatch bounding;
  BoundingCounts found;
  std::vector<ChunkBounds> bounds = chunks->bounds(job, found);
  const double bound_s = bounding.seconds();
  statistics.stages_s["bound"] += bound_s;
  if (job.progress.cancelled()) return nullptr;
  statistics.growth.chunks += static_cast<int64_t>(chunks->size());
  statistics.growth.area += found.area;

  ResidentChunksOptions options;
  options.kind = scene.render.accel;
  options.chunk.shape = scene.render.curves;
  options.chunk.compact_attributes = options.fur.compact_attributes = scene.render.compact_attributes;
  if (const float width = scene.render.min_width(); width > 0)
    options.fur.min_width = MinWidth{scene.camera.lod_view(), width};
  options.eager = scene.render.bounds == BoundingStrategy::kNone;
  options.memory_limit = scene.render.memory.bytes;
  options.threads = job.workers.thread_count();
  options.opaque = chunks->opaque();
  const Stopwatch storing;
  const bool may_store = !options.eager && chunks->in_fur_trees();
  const bool stores = !scene.render.bvh.file.empty() && may_store;
  if (!scene.render.bvh.file.empty() && !may_store) {
    job.progress.warn(
        "render.bvh.file: nothing is stored, because it needs accel: fur, curves: flat, and bounds other "
        "than none");
  }
  if (stores) {
    options.file = stored_fur(scene.render, *chunks, options, job);
    if (job.progress.cancelled()) return nullptr;
  }
  const double store_s = storing.seconds();
  if (stores) statistics.stages_s["store"] += store_s;
  const Stopwatch growing;
  std::unique_ptr<const FrameGeometry> geometry(
      new FrameGeometry(std::move(chunks), std::move(bounds), options, job));
  const double grow_s = options.eager ? growing.seconds() : 0;
  if (options.eager) statistics.stages_s["grow"] += grow_s;
  statistics.stages_s["prepare"] += preparing.seconds() - bound_s - store_s - grow_s;
  if (!job.progress.cancelled()) return geometry;
  geometry->add_to(statistics);
  return nullptr;
} catch (const Error& error) {
  if (error.kind() != ErrorKind::kStopped) throw;
  return nullptr;
}

void FrameGeometry::add_to(FrameStatistics& statistics) const {
  statistics.growth.strands += chunks_->strands_grown();
  statistics.residency += chunks().counts();
  if (stored_) statistics.reads += stored_->reads();
}

}  // namespace pelage
