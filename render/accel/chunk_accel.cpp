// SPDX-License-Identifier: Apache-2.0
#include "render/accel/chunk_accel.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "render/accel/embree_query.h"
#include "render/accel/segment_cell_hits.h"

namespace pelage {
namespace {

// Before a visit, which is cheap, testing learned boxes is worthwhile only if they are this many times finer
// than the given ones. Before a chunk is grown, it is always worthwhile.
constexpr size_t kFiner = 8;
constexpr uint32_t kUnknown = ~0u;  // number of boxes for a chunk without cell bounds

}  // namespace

/// Per-thread state of the current ray.
struct alignas(64) ChunkAccel::Scratch {
  struct Waiting {
    float entry;
    uint32_t boxes;  // number of cell bounds that the ray intersects
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

/// The visits of one ray: calls visit(chunk) for every chunk that the ray may hit before far(), which
/// may decrease between visits; ends when a visit returns false.
template <class Far, class Visit>
class ChunkAccel::Visits {
 public:
  Visits(const ResidentChunks& chunks, Scratch& scratch, const Ray& ray, ChunkWalk::Order order,
         TraceThread& thread, const Far& far, const Visit& visit)
      : chunks_(chunks),
        boxes_(chunks.boxes()),
        scratch_(scratch),
        any_(order == ChunkWalk::Order::kLongestFirst),
        walk_(*boxes_.tree(), ray, order),
        counts_(thread.counts),
        far_(far),
        visit_(visit) {}

  void run() {
    scratch_.next_ray();
    if (visit_resident()) visit_waiting();
  }

 private:
  using Waiting = Scratch::Waiting;
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();

  /// Distance at which the ray enters the known boxes of the chunk; infinity when it misses them. For a ray
  /// that looks for any blocker, `cells_hit` becomes the number of cell bounds that it intersects.
  float enter(uint32_t chunk, float entry, bool resident, uint32_t& cells_hit) {
    if (resident && boxes_.in_fur_tree(chunk)) return entry;
    const float until = far_();
    const PartBoxes* learned = boxes_.learned(chunk);
    if (learned && (!resident || learned->count() >= kFiner * boxes_.parts_in_tree(chunk))) {
      counts_.box_tests += static_cast<int64_t>(learned->count());
      entry = learned->enter(walk_.slabs(), until);
    }
    if (resident || !boxes_.has_cell_bounds(chunk) || entry == kInfinity) return entry;
    const SegmentCellHits hits = intersect_segment_cell_bounds(
        boxes_.cell_bounds(chunk), walk_.slabs(), until, any_, counts_.box_tests, boxes_.margin(chunk));
    cells_hit = hits.boxes;
    return hits.entry;
  }
  bool reaches(float entry) const {
    return entry <= far_() && entry < kInfinity;  // the far end of a ray may be infinite too
  }
  bool visit_one(uint32_t chunk) {
    ++counts_.chunk_visits;
    return visit_(chunk);
  }

  /// Visits resident chunks, and finds the others.
  bool visit_resident() {
    uint32_t chunk = 0;
    float entry = 0;
    bool goes_on = true;
    while (goes_on && walk_.next(far_(), chunk, entry)) {
      if (!scratch_.first_time(chunk)) {
        // Boxes are not strictly ordered: one of a pending chunk may be entered before those seen so far.
        // Cell bounds were all tested together.
        if (boxes_.has_cell_bounds(chunk)) continue;
        for (Waiting& waiting : scratch_.waiting) {
          if (waiting.chunk == chunk) waiting.entry = std::min(waiting.entry, entry);
        }
        continue;
      }
      const bool resident = chunks_.is_resident(chunk);
      uint32_t cells_hit = kUnknown;
      entry = enter(chunk, entry, resident, cells_hit);
      if (!reaches(entry)) continue;
      if (resident) {
        goes_on = visit_one(chunk);
      } else {
        scratch_.waiting.push_back({entry, cells_hit, chunk});
      }
    }
    counts_.box_tests += walk_.box_tests();
    return goes_on;
  }
  /// Visits chunks that were not resident.
  void visit_waiting() {
    // Nearest first; for occlusion, the most likely blockers first: skins, then chunks with the most
    // intersected boxes.
    std::sort(scratch_.waiting.begin(), scratch_.waiting.end(), [&](const Waiting& a, const Waiting& b) {
      if (any_ && a.boxes != b.boxes) return a.boxes > b.boxes;
      return a.entry != b.entry ? a.entry < b.entry : a.chunk < b.chunk;
    });
    const float looked_until = far_();
    for (Waiting& waiting : scratch_.waiting) {
      if (waiting.entry > far_()) continue;
      // Meanwhile the ray may have become shorter, and another thread may have grown the chunk.
      const bool tells_more = far_() < looked_until || boxes_.learned(waiting.chunk);
      if (tells_more && !reaches(enter(waiting.chunk, waiting.entry, false, waiting.boxes))) continue;
      ++counts_.absent_visits;
      if (!visit_one(waiting.chunk)) return;
    }
  }

  const ResidentChunks& chunks_;
  const ChunkBoxes& boxes_;
  Scratch& scratch_;
  const bool any_;
  ChunkWalk walk_;
  TraceCounts& counts_;
  const Far& far_;
  const Visit& visit_;
};

template <class Far, class Visit>
void ChunkAccel::visit_chunks(const Ray& ray, ChunkWalk::Order order, TraceThread& thread, const Far& far,
                              const Visit& visit) const {
  Visits<Far, Visit>(chunks_, scratch_[static_cast<size_t>(thread.worker)], ray, order, thread, far, visit)
      .run();
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
          return geometry.closest(ray, rays, nearest, thread.hit_geometry);
        });
        if (found) nearest_chunk = chunk;
        return true;
      });
  // Only the final answer counts: other hits on the way depend on the order of visits.
  if (nearest_chunk) chunks_.mark_hit(*nearest_chunk);
  return nearest.hit;
}

bool ChunkAccel::collect(const Ray& ray, TraceThread& thread, Crossings& crossings) const {
  FurRays rays;
  bool blocked = false;
  visit_chunks(
      ray, ChunkWalk::Order::kLongestFirst, thread, [&] { return ray.far; },
      [&](uint32_t chunk) {
        if (ray.casters && !ray.casters->contains({chunks_.is_skin(chunk), chunks_.part(chunk)})) return true;
        const size_t before = crossings.reports();
        blocked = !chunks_.visit(chunk, thread.worker, [&](const ChunkGeometry& geometry) {
          return geometry.collect(ray, rays, crossings);
        });
        if (blocked || crossings.reports() != before) chunks_.mark_hit(chunk);
        return !blocked;
      });
  return !blocked;
}

float ChunkAccel::transmittance(const Ray& ray, TraceThread& thread) const {
  if (!is_finite(ray)) return 1;
  Crossings crossings;
  return collect(ray, thread, crossings) ? crossings.transmittance() : 0.0f;
}

StrandCount ChunkAccel::strands_crossed(const Ray& ray, uint32_t max, TraceThread& thread) const {
  if (!is_finite(ray)) return {};
  Crossings crossings(std::max(max, 1u));
  if (collect(ray, thread, crossings)) return crossings.total();
  return {std::numeric_limits<float>::infinity(), 0};
}

}  // namespace pelage
