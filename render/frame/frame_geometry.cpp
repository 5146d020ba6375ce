// SPDX-License-Identifier: Apache-2.0
#include "render/frame/frame_geometry.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "render/frame/stored_fur.h"

namespace pelage {

FrameGeometry::FrameGeometry(std::unique_ptr<const FrameChunks> chunks, std::vector<ChunkBounds> bounds,
                             const ResidentChunksOptions& options, const Job& job,
                             std::vector<KeptChunk> kept)
    : chunks_(std::move(chunks)),
      chunks_charge_(job.ledger, MemoryTag::kChunks, static_cast<int64_t>(chunks_->bytes())),
      stored_(options.file),
      stored_charge_(job.ledger, MemoryTag::kChunks,
                     options.file ? static_cast<int64_t>(options.file->bytes()) : 0),
      accel_(std::move(bounds), *chunks_, options, job, std::move(kept)) {}

namespace {

/// The leaves of a frame, and what is known about them from an earlier frame.
struct KnownLeaves {
  std::vector<std::optional<ContentHash>> contents;
  std::vector<KeptChunk*> kept;            // null if unknown
  std::vector<const ChunkBounds*> bounds;  // null if unknown
};

KnownLeaves known_leaves(FrameChunks& chunks, KeptFur& fur) {
  KnownLeaves known;
  for (uint32_t leaf = 0; leaf < chunks.leaves().size(); ++leaf) {
    known.contents.push_back(chunks.content(leaf));
    KeptChunk* const kept = known.contents.back() ? fur.find(*known.contents.back()) : nullptr;
    known.kept.push_back(kept);
    known.bounds.push_back(kept && !kept->bounds.boxes.empty() ? &kept->bounds : nullptr);
    // A leaf that has changed counts as grown again.
    if (fur.has_frame() && (!kept || kept->grown)) chunks.mark_grown(leaf);
  }
  return known;
}

std::vector<KeptChunk> take(const KnownLeaves& known, KeptFur& fur) {
  std::vector<KeptChunk> chunks(known.kept.size());
  for (size_t leaf = 0; leaf < chunks.size(); ++leaf) {
    // If two leaves have equal contents, the first one gets the chunk.
    if (known.kept[leaf]) chunks[leaf] = std::move(*known.kept[leaf]);
  }
  fur.clear();
  return chunks;
}

}  // namespace

std::unique_ptr<FrameGeometry> FrameGeometry::make(const RenderScene& scene, const Job& job,
                                                   FrameStatistics& statistics, KeptFur* kept) try {
  const Stopwatch preparing;
  auto chunks = std::make_unique<FrameChunks>(scene, job);
  const bool is_quick = kept && chunks->bound_quickly(job);
  const bool at_once = !kept && scene.render.bvh.file.empty() && chunks->grow_at_once(job);
  KnownLeaves known;
  if (kept) known = known_leaves(*chunks, *kept);
  const Stopwatch bounding;
  BoundingCounts found;
  std::vector<ChunkBounds> bounds = chunks->bounds(job, found, known.bounds);
  const double bound_s = bounding.seconds();
  statistics.stages_s["bound"] += bound_s;
  if (job.progress.cancelled()) return nullptr;
  statistics.growth.chunks += static_cast<int64_t>(chunks->size());
  statistics.growth.area += found.area;

  ResidentChunksOptions options;
  options.kind = scene.render.accel;
  options.chunk.shape = scene.render.curves;
  options.chunk.compact_attributes = options.fur.compact_attributes = scene.render.compact_attributes;
  options.chunk.screen_door = options.fur.screen_door = scene.render.screen_door;
  if (const float width = scene.render.min_width(); width > 0)
    options.fur.min_width = MinWidth{scene.camera.lod_view(), width};
  options.eager = at_once || scene.render.bounds == BoundingStrategy::kNone;
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
    if (options.file && !kept) chunks->store_skins(job);
    if (job.progress.cancelled()) return nullptr;
  }
  const double store_s = storing.seconds();
  if (stores) statistics.stages_s["store"] += store_s;
  if (kept) options.pool = kept->pool();
  const Stopwatch growing;
  std::unique_ptr<FrameGeometry> geometry(
      new FrameGeometry(std::move(chunks), std::move(bounds), options, job,
                        kept ? take(known, *kept) : std::vector<KeptChunk>()));
  geometry->contents_ = std::move(known.contents);
  geometry->is_quick_ = is_quick;
  const double grow_s = options.eager ? growing.seconds() : 0;
  if (options.eager) statistics.stages_s["grow"] += grow_s;
  statistics.stages_s["prepare"] += preparing.seconds() - bound_s - store_s - grow_s;
  if (at_once && !job.progress.cancelled()) statistics.growth.area += geometry->chunks_area();
  if (!job.progress.cancelled()) return geometry;
  geometry->add_to(statistics);
  if (kept) geometry->release(*kept, job.ledger);
  return nullptr;
} catch (const Error& error) {
  if (error.kind() != ErrorKind::kStopped) throw;
  return nullptr;
}

BoundsArea FrameGeometry::chunks_area() const {
  BoundsArea area;
  for (uint32_t leaf = 0; leaf < chunks_->leaves().size(); ++leaf)
    area += area_of({1, {chunks().boxes().whole(leaf)}, {}});
  return area;
}

void FrameGeometry::release(KeptFur& kept, MemoryLedger& ledger) {
  std::vector<std::pair<ContentHash, KeptChunk>> chunks;
  for (uint32_t leaf = 0; leaf < contents_.size(); ++leaf) {
    if (!contents_[leaf]) continue;
    chunks.emplace_back(*contents_[leaf], accel_.chunks().release(leaf, ledger));
    chunks.back().second.grown = chunks_->was_grown(leaf);
  }
  kept.replace(std::move(chunks));
}

void FrameGeometry::add_to(FrameStatistics& statistics) const {
  statistics.growth.strands += chunks_->strands_grown();
  statistics.residency += chunks().counts();
  if (stored_) statistics.reads += stored_->reads();
}

}  // namespace pelage
