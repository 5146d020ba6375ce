// SPDX-License-Identifier: Apache-2.0
#include "render/accel/chunk_accel.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "render/accel/embree_query.h"
#include "render/accel/fine_box_hits.h"

namespace pelage {
namespace {

// Before a visit, which is cheap, testing learned boxes is worthwhile only if they are this many times finer
// than the given ones. Before a chunk is grown, it is always worthwhile.
constexpr size_t kFiner = 8;
constexpr uint32_t kUnknown = ~0u;  // number of boxes for a chunk without fine ones

}  // namespace

/// Per-thread state of the current ray.
struct alignas(64) ChunkAccel::Scratch {
  struct Waiting {
    float entry;
    uint32_t boxes;  // number of fine ones that the ray intersects
    uint32_t chunk;
  };

  /// Whether this is the ray's first visit of the chunk; marks it as visited.
  bool first_time(uint32_t chunk) {
    if (seen[chunk] == ray) return false;
    seen[chunk] = ray;
    return true;
  }
  void next_ray() {
    waiting.clear();
    if (++ray != 0) return;
    std::fill(seen.begin(), seen.end(), 0u);
    ray = 1;
  }

  uint32_t ray = 0;            // number of the current ray
  std::vector<uint32_t> seen;  // by chunk: the last ray that visited it
  std::vector<Waiting> waiting;
};

ChunkAccel::ChunkAccel(std::vector<ChunkBounds> bounds, const ChunkGrower& grower,
                       const ResidentChunksOptions& options, const Job& job, std::vector<KeptChunk> kept)
    : scratch_charge_(
          job.ledger, MemoryTag::kChunks,
          static_cast<int64_t>(static_cast<size_t>(options.threads) * bounds.size() * sizeof(uint32_t))),
      scratch_(std::make_unique<Scratch[]>(static_cast<size_t>(options.threads))),
      chunks_(std::move(bounds), grower, options, job, std::move(kept)) {
  for (int i = 0; i < options.threads; ++i) scratch_[static_cast<size_t>(i)].seen.resize(chunks_.size());
}

ChunkAccel::~ChunkAccel() = default;

/// Calls visit(chunk) for every chunk that the ray may hit before far(), which may decrease between visits;
/// ends when a visit returns false.
template <class Far, class Visit>
void ChunkAccel::visit_chunks(const Ray& ray, ChunkWalk::Order order, TraceThread& thread, const Far& far,
                              const Visit& visit) const {
  Scratch& scratch = scratch_[static_cast<size_t>(thread.worker)];
  scratch.next_ray();
  const ChunkBoxes& boxes = chunks_.boxes();
  ChunkWalk walk(*boxes.tree(), ray, order);
  const bool any = order == ChunkWalk::Order::kLongestFirst;
  // Distance at which the ray enters the known boxes of the chunk; infinity when it misses them. For a ray
  // that looks for any blocker, `met` becomes the number of fine boxes that it intersects.
  const auto enter = [&](uint32_t chunk, float entry, bool resident, uint32_t& met) {
    const PartBoxes* learned = boxes.learned(chunk);
    if (learned && (!resident ||
                    (!boxes.in_fur_tree(chunk) && learned->count() >= kFiner * boxes.parts_in_tree(chunk)))) {
      thread.counts.box_tests += static_cast<int64_t>(learned->count());
      entry = learned->enter(walk.slabs(), far());
    }
    if (resident || !boxes.has_fine(chunk) || entry == std::numeric_limits<float>::infinity()) return entry;
    const FineBoxHits hits = intersect_fine_boxes(boxes.fine(chunk), walk.slabs(), far(), any,
                                                  thread.counts.box_tests, boxes.margin(chunk));
    met = hits.boxes;
    return hits.entry;
  };
  // The far end of a ray may be infinite too.
  const auto reaches = [&](float entry) {
    return entry <= far() && entry < std::numeric_limits<float>::infinity();
  };
  const auto visit_one = [&](uint32_t chunk) {
    ++thread.counts.chunk_visits;
    return visit(chunk);
  };

  uint32_t chunk = 0;
  float entry = 0;
  bool goes_on = true;
  while (goes_on && walk.next(far(), chunk, entry)) {
    if (!scratch.first_time(chunk)) {
      // Boxes are not strictly ordered: one of a pending chunk may be entered before those seen so far. Fine
      // boxes were all tested together.
      if (boxes.has_fine(chunk)) continue;
      for (Scratch::Waiting& waiting : scratch.waiting) {
        if (waiting.chunk == chunk) waiting.entry = std::min(waiting.entry, entry);
      }
      continue;
    }
    const bool resident = chunks_.is_resident(chunk);
    uint32_t met = kUnknown;
    entry = enter(chunk, entry, resident, met);
    if (!reaches(entry)) continue;
    if (resident) {
      goes_on = visit_one(chunk);
    } else {
      scratch.waiting.push_back({entry, met, chunk});
    }
  }
  thread.counts.box_tests += walk.box_tests();
  if (!goes_on) return;
  // Nearest first; for occlusion, the most likely blockers first: skins, then chunks with the most
  // intersected boxes.
  using Waiting = Scratch::Waiting;
  std::sort(scratch.waiting.begin(), scratch.waiting.end(), [any](const Waiting& a, const Waiting& b) {
    if (any && a.boxes != b.boxes) return a.boxes > b.boxes;
    return a.entry != b.entry ? a.entry < b.entry : a.chunk < b.chunk;
  });
  const float looked_until = far();
  for (Waiting& waiting : scratch.waiting) {
    if (waiting.entry > far()) continue;
    // Meanwhile the ray may have become shorter, and another thread may have grown the chunk.
    const bool tells_more = far() < looked_until || boxes.learned(waiting.chunk);
    if (tells_more && !reaches(enter(waiting.chunk, waiting.entry, false, waiting.boxes))) continue;
    ++thread.counts.absent_visits;
    if (!visit_one(waiting.chunk)) return;
  }
}

Hit ChunkAccel::closest(const Ray& ray, TraceThread& thread) const {
  NearestSoFar nearest;
  FurRays rays;
  std::optional<uint32_t> nearest_chunk;
  if (!is_finite(ray)) return nearest.hit;
  visit_chunks(
      ray, ChunkWalk::Order::kFrontToBack, thread, [&] { return std::min(ray.far, nearest.hit.distance); },
      [&](uint32_t chunk) {
        const bool found = chunks_.visit(chunk, thread.worker, [&](const ChunkGeometry& geometry) {
          return geometry.closest(ray, rays, nearest, thread.met);
        });
        if (found) nearest_chunk = chunk;
        return true;
      });
  // Only the final answer counts: other hits on the way depend on the order of visits.
  if (nearest_chunk) chunks_.mark_hit(*nearest_chunk);
  return nearest.hit;
}

float ChunkAccel::transmittance(const Ray& ray, TraceThread& thread) const {
  if (!is_finite(ray)) return 1;
  FurRays rays;
  Crossings crossings;
  bool blocked = false;
  visit_chunks(
      ray, ChunkWalk::Order::kLongestFirst, thread, [&] { return ray.far; },
      [&](uint32_t chunk) {
        const size_t before = crossings.reports();
        blocked = !chunks_.visit(chunk, thread.worker, [&](const ChunkGeometry& geometry) {
          return geometry.collect(ray, rays, crossings);
        });
        if (blocked || crossings.reports() != before) chunks_.mark_hit(chunk);
        return !blocked;
      });
  return blocked ? 0.0f : crossings.transmittance();
}

}  // namespace pelage
