// SPDX-License-Identifier: Apache-2.0
#include "render/accel/chunk_accel.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <optional>
#include <span>

#include "base/parallel.h"
#include "base/progress.h"
#include "render/accel/embree_query.h"
#include "render/accel/fine_box_hits.h"
#include "render/accel/part_bounds.h"

namespace pelage {
namespace {

constexpr size_t kPage = 4096;
constexpr size_t kSegmentsPerPart = 1024, kMaxParts = 64;
// Testing learned boxes before a visit, which is cheap, is worthwhile only where they are this many times
// finer than the given ones; before a chunk is grown, always.
constexpr size_t kFiner = 8;
constexpr uint32_t kUnknown = ~0u;  // number of boxes for a chunk without fine ones

size_t part_count(size_t primitives) {
  return std::clamp<size_t>(primitives / kSegmentsPerPart, 1, kMaxParts);
}

/// Upper bound: no strand is wider than its box.
float widest_radius(const ChunkBounds& bounds) {
  const Box3f box = bounds.whole();
  const V3f size = box.isEmpty() ? V3f(0) : box.size();
  return 0.5f * std::min({size.x, size.y, size.z});
}

}  // namespace

/// Grows chunks for the residency, and stores what is known about each before it is grown: the given fine
/// boxes, or boxes learned when it was first grown.
class ChunkAccel::Growth final : public Grower {
 public:
  /// Moves the fine boxes out of `bounds`. For chunks that will use fur trees, enlarges the remaining boxes
  /// by the error of snapping to a grid, and keeps a single part: the tree of a resident chunk is cheaper to
  /// test than boxes above it.
  Growth(const ChunkGrower& grower, std::span<ChunkBounds> bounds, const ChunkAccelOptions& options,
         const EmbreeDevice& device, SegmentPatterns& patterns, MemoryLedger& ledger, Progress& progress)
      : grower_(grower),
        options_(options),
        progress_(progress),
        fur_(with_pool(options.fur)),
        device_(device),
        patterns_(patterns),
        known_(bounds.size()),
        learned_(bounds.size()),
        build_pages_(bounds.size()) {
    size_t bytes = bounds.size() * (sizeof(known_[0]) + sizeof(learned_[0]) + sizeof(build_pages_[0]));
    for (uint32_t chunk = 0; chunk < bounds.size(); ++chunk) {
      const ChunkCounts counts = grower.counts(chunk);
      if (belongs_in_fur_tree(chunk)) {
        known_[chunk].margin = grid(chunk).margin(widest_radius(bounds[chunk]));
        widen(bounds[chunk], known_[chunk].margin);
        known_[chunk].in_fur_tree = true;
        bounds[chunk] = std::move(bounds[chunk]).in_one_part();
      } else if (counts.strands > 0 && counts.segments % counts.strands == 0)
        patterns.expect(counts.segments / counts.strands, counts.strands);
      KnownBounds& known = known_[chunk];
      known.fine = std::move(bounds[chunk].fine);
      // For a moving chunk, boxes over a longer time than the shutter are less tight than learned ones.
      known.learns = known.fine.count() == 0 || (counts.motion_keys > 1 && bounds[chunk].keys == 1);
      bytes += known.fine.bytes();
      if (known.learns)
        bytes += PartBoxes::bytes_bound(part_count(counts.segments + counts.triangles) + 3,
                                        counts.motion_keys > 1);
    }
    charge_ = MemoryCharge(ledger, MemoryTag::kChunks, static_cast<int64_t>(bytes));
  }
  ~Growth() override {
    for (auto& boxes : learned_) delete boxes.load(std::memory_order_relaxed);
  }

  size_t reserve_bytes(uint32_t slot) const override {
    if (is_stored(slot)) return options_.file->bytes_bound(slot);
    ChunkCounts counts = grower_.counts(slot);
    const size_t build_peak = kPage * size_t(build_pages_[slot].load(std::memory_order_relaxed));
    const bool fur = in_fur_tree(slot);
    if (build_peak > 0)
      return fur ? FurChunk::bytes_bound(counts, build_peak) : EmbreeChunk::bytes_bound(counts, build_peak);
    if (fur) return FurChunk::bytes_bound(counts, fur_);
    if (known_[slot].learns) counts.growth_bytes = std::max(counts.growth_bytes, part_bounds_scratch(counts));
    return EmbreeChunk::bytes_bound(counts);
  }

  std::string name(uint32_t slot) const override { return grower_.name(slot); }

  Grown grow(uint32_t slot) override {
    // Only one thread at a time grows a slot, so the learned boxes have one writer.
    const bool learns = known_[slot].learns && !learned(slot);
    if (is_stored(slot)) {
      const auto warn = [this](const std::string& line) { progress_.warn(line); };
      if (std::unique_ptr<FurChunk> fur = options_.file->read(slot, warn, &pool_)) {
        if (learns) learn(slot, fur->part_bounds(part_count(fur->segment_count())));
        const size_t bytes = fur->bytes();
        return {std::move(fur), bytes};
      }
      // It is no longer in the file: growing it needs more memory than was estimated for reading it.
      const size_t needed = reserve_bytes(slot);
      if (needed > options_.file->bytes_bound(slot)) return {nullptr, needed};
    }
    ChunkContents contents = grower_.grow(slot);
    std::unique_ptr<ChunkGeometry> unit;
    ChunkBounds bounds;
    if (in_fur_tree(slot)) {
      auto fur = std::make_unique<FurChunk>(std::move(contents), slot, grid(slot), fur_);
      if (learns) bounds = fur->part_bounds(options_.eager ? 1 : part_count(fur->segment_count()));
      unit = std::move(fur);
    } else {
      if (learns) bounds = part_bounds(contents, kSegmentsPerPart, kMaxParts);
      unit = std::make_unique<EmbreeChunk>(std::move(contents), slot, grower_.scale(slot).widest,
                                           options_.chunk, device_, patterns_);
    }
    if (learns) learn(slot, bounds);
    const size_t bytes = unit->bytes();
    build_pages_[slot].store(static_cast<uint32_t>(unit->build_peak_bytes() / kPage + 1),
                             std::memory_order_relaxed);
    return {std::move(unit), bytes};
  }

  /// Null before the chunk was first grown, and when the fine boxes are as tight.
  const PartBoxes* learned(uint32_t slot) const { return learned_[slot].load(std::memory_order_acquire); }
  const FineBoxes& fine(uint32_t slot) const { return known_[slot].fine; }
  /// By how much fine boxes must be enlarged.
  float margin(uint32_t slot) const { return known_[slot].margin; }
  bool in_fur_tree(uint32_t slot) const { return known_[slot].in_fur_tree; }
  bool knows(uint32_t slot) const { return fine(slot).count() > 0; }

 private:
  struct KnownBounds {
    FineBoxes fine;
    float margin = 0;
    bool learns = true;
    bool in_fur_tree = false;
  };

  void learn(uint32_t slot, const ChunkBounds& bounds) {
    learned_[slot].store(std::make_unique<const PartBoxes>(bounds).release(), std::memory_order_release);
  }
  bool is_stored(uint32_t slot) const { return options_.file && !options_.eager && options_.file->has(slot); }
  bool belongs_in_fur_tree(uint32_t slot) const {
    return in_fur_trees(options_.kind, options_.chunk.shape) && !grower_.is_skin(slot);
  }
  FurGrid grid(uint32_t slot) const {
    const StrandScale scale = grower_.scale(slot);
    return FurGrid(scale.width, scale.anchor);
  }
  FurChunkOptions with_pool(FurChunkOptions options) {
    options.tree.pool = &pool_;
    return options;
  }

  PagePool pool_;  // for all trees
  const ChunkGrower& grower_;
  const ChunkAccelOptions& options_;
  Progress& progress_;
  const FurChunkOptions fur_;
  const EmbreeDevice& device_;
  SegmentPatterns& patterns_;
  std::vector<KnownBounds> known_;
  std::vector<std::atomic<const PartBoxes*>> learned_;
  std::vector<std::atomic<uint32_t>> build_pages_;  // memory that the tree needed during its last build
  MemoryCharge charge_;
};

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
                       const ChunkAccelOptions& options, const Job& job)
    : options_(options), patterns_(job.ledger) {
  const size_t chunks = bounds.size();
  const auto threads = static_cast<size_t>(options.threads);
  scratch_ = std::make_unique<Scratch[]>(threads);
  for (size_t i = 0; i < threads; ++i) scratch_[i].seen.resize(chunks);
  charges_.emplace_back(job.ledger, MemoryTag::kChunks,
                        static_cast<int64_t>(threads * chunks * sizeof(uint32_t)));
  growth_ = std::make_unique<Growth>(grower, bounds, options_, device_, patterns_, job.ledger, job.progress);

  if (!options.eager) build_tree(bounds, job);
  residency_ = std::make_unique<Residency>(
      *growth_, chunks, options.threads, MemoryBudget{options.memory_limit}, job.ledger, MemoryTag::kChunks);
  if (!options.eager) {
    int64_t all = job.ledger.budgeted();
    for (uint32_t chunk = 0; chunk < chunks; ++chunk)
      all += static_cast<int64_t>(growth_->reserve_bytes(chunk));
    fits_ = options.memory_limit == 0 || all <= static_cast<int64_t>(options.memory_limit);
    return;
  }
  residency_->grow_all(job);
  if (job.progress.cancelled()) return;
  for (uint32_t chunk = 0; chunk < chunks; ++chunk) {
    bounds[chunk] = growth_->learned(chunk)->bounds();
    if (growth_->in_fur_tree(chunk)) bounds[chunk] = std::move(bounds[chunk]).in_one_part();
  }
  build_tree(bounds, job);
}

ChunkAccel::~ChunkAccel() = default;

void ChunkAccel::build_tree(const std::vector<ChunkBounds>& bounds, const Job& job) {
  given_parts_.reserve(bounds.size());
  for (const ChunkBounds& chunk : bounds) given_parts_.push_back(static_cast<uint32_t>(chunk.part_count()));
  tree_ = std::make_unique<ChunkTree>(bounds, job.workers);
  charges_.emplace_back(job.ledger, MemoryTag::kChunks,
                        static_cast<int64_t>(tree_->bytes() + bounds.size() * sizeof(uint32_t)));
}

/// Calls visit(chunk) for every chunk that the ray may hit before far(), which may decrease between visits;
/// ends when a visit returns false.
template <class Far, class Visit>
void ChunkAccel::visit_chunks(const Ray& ray, ChunkWalk::Order order, TraceThread& thread, const Far& far,
                              const Visit& visit) const {
  Scratch& scratch = scratch_[static_cast<size_t>(thread.worker)];
  scratch.next_ray();
  ChunkWalk walk(*tree_, ray, order);
  const bool any = order == ChunkWalk::Order::kLongestFirst;
  // Entry distance of the ray according to the known boxes of the chunk; infinity when it misses. `boxes`
  // becomes the number of fine ones that an occlusion ray intersects.
  const auto enter = [&](uint32_t chunk, float entry, bool resident, uint32_t& boxes) {
    const PartBoxes* learned = growth_->learned(chunk);
    if (learned &&
        (!resident || (!growth_->in_fur_tree(chunk) && learned->count() >= kFiner * given_parts_[chunk]))) {
      thread.counts.box_tests += static_cast<int64_t>(learned->count());
      entry = learned->enter(walk.slabs(), far());
    }
    if (resident || !growth_->knows(chunk) || entry == std::numeric_limits<float>::infinity()) return entry;
    const FineBoxHits hits = intersect_fine_boxes(growth_->fine(chunk), walk.slabs(), far(), any,
                                                  thread.counts.box_tests, growth_->margin(chunk));
    boxes = hits.boxes;
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
      if (growth_->knows(chunk)) continue;
      for (Scratch::Waiting& waiting : scratch.waiting) {
        if (waiting.chunk == chunk) waiting.entry = std::min(waiting.entry, entry);
      }
      continue;
    }
    const bool resident = residency_->is_resident(chunk);
    uint32_t boxes = kUnknown;
    entry = enter(chunk, entry, resident, boxes);
    if (!reaches(entry)) continue;
    if (resident) {
      goes_on = visit_one(chunk);
    } else {
      scratch.waiting.push_back({entry, boxes, chunk});
    }
  }
  thread.counts.box_tests += walk.box_tests();
  if (!goes_on) return;
  // Nearest first, or for occlusion what most likely blocks the ray: skins, then chunks with the most
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
    const bool tells_more = far() < looked_until || growth_->learned(waiting.chunk);
    if (tells_more && !reaches(enter(waiting.chunk, waiting.entry, false, waiting.boxes))) continue;
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
        const bool found = residency_->visit(chunk, thread.worker, [&](Resident& unit) {
          return static_cast<const ChunkGeometry&>(unit).closest(ray, rays, nearest, thread.met);
        });
        if (found) nearest_chunk = chunk;
        return true;
      });
  // Only the final answer counts: other hits on the way depend on the order of visits.
  if (nearest_chunk) residency_->mark_hit(*nearest_chunk);
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
        blocked = !residency_->visit(chunk, thread.worker, [&](Resident& unit) {
          return static_cast<const ChunkGeometry&>(unit).collect(ray, rays, crossings);
        });
        if (blocked || crossings.reports() != before) residency_->mark_hit(chunk);
        return !blocked;
      });
  return blocked ? 0.0f : crossings.transmittance();
}

}  // namespace pelage
