// SPDX-License-Identifier: Apache-2.0
#include "render/accel/resident_chunks.h"

#include <algorithm>

#include "base/check.h"
#include "base/progress.h"

namespace pelage {
namespace {

constexpr size_t kPage = 4096;

}  // namespace

ResidentChunks::ResidentChunks(std::vector<ChunkBounds> bounds, const ChunkGrower& grower,
                               const ResidentChunksOptions& options, const Job& job,
                               std::vector<KeptChunk> kept)
    : grower_(grower),
      options_(options),
      pool_(options.pool ? options.pool : std::make_shared<PagePool>()),
      fur_(options.fur),
      progress_(job.progress),
      patterns_(job.ledger),
      boxes_(options.eager ? std::vector<ChunkBounds>(bounds.size()) : std::move(bounds), grower,
             in_fur_trees(options.kind, options.chunk.shape)),
      build_pages_(boxes_.size()) {
  fur_.tree.pool = pool_.get();
  // Kept chunks may be evicted, so they do not count where the budget is checked.
  for (KeptChunk& chunk : kept) chunk.charge = {};
  expect_patterns();
  const auto charge = [&](size_t bytes) {
    charges_.emplace_back(job.ledger, MemoryTag::kChunks, static_cast<int64_t>(bytes));
  };
  charge(boxes_.bytes_bound() + size() * sizeof(build_pages_[0]));
  // The residency checks the smallest sufficient budget, so everything else is charged first.
  if (!options_.eager) {
    boxes_.build_tree(job.workers);
    tree_charge_ = tree_charge(job.ledger);
  }
  residency_.emplace(static_cast<Grower&>(*this), size(), options_.threads,
                     MemoryBudget{options_.memory_limit}, job.ledger, MemoryTag::kChunks);
  if (!options_.eager) {
    find_whether_all_fit(job.ledger);
    adopt(std::move(kept), job.ledger);
    return;
  }
  adopt(std::move(kept), job.ledger);
  residency_->grow_all(job);
  if (job.progress.cancelled()) return;
  boxes_.build_tree_of_learned(job.workers);
  tree_charge_ = tree_charge(job.ledger);
}

MemoryCharge ResidentChunks::tree_charge(MemoryLedger& ledger) const {
  return {ledger, MemoryTag::kChunks, static_cast<int64_t>(boxes_.tree()->bytes())};
}

void ResidentChunks::tighten(const Job& job) {
  boxes_.tighten(job.workers);
  tree_charge_ = tree_charge(job.ledger);
}

/// Charges the arrays that Embree's chunks share before any chunk is grown.
void ResidentChunks::expect_patterns() {
  for (uint32_t chunk = 0; chunk < size(); ++chunk) {
    if (boxes_.in_fur_tree(chunk) || is_skin(chunk)) continue;
    const ChunkCounts counts = grower_.counts(chunk);
    if (counts.strands > 0 && counts.segments % counts.strands == 0)
      patterns_.expect(counts.segments / counts.strands, counts.strands);
  }
}

void ResidentChunks::find_whether_all_fit(const MemoryLedger& ledger) {
  int64_t all = ledger.budgeted();
  for (uint32_t chunk = 0; chunk < size(); ++chunk) all += static_cast<int64_t>(reserve_bytes(chunk));
  fits_ = options_.memory_limit == 0 || all <= static_cast<int64_t>(options_.memory_limit);
}

void ResidentChunks::adopt(std::vector<KeptChunk> kept, const MemoryLedger& ledger) {
  for (uint32_t chunk = 0; chunk < kept.size(); ++chunk) {
    std::unique_ptr<FurChunk> fur = std::move(kept[chunk].fur);
    if (kept[chunk].learned && boxes_.may_learn(chunk)) boxes_.learn(chunk, std::move(kept[chunk].learned));
    const bool measured = !boxes_.may_learn(chunk) || boxes_.learned(chunk);
    if (!fur || !boxes_.in_fur_tree(chunk) || (options_.eager && !measured)) continue;
    fur->unwiden();
    if (fur_.min_width) fur->widen(*fur_.min_width);
    fur->set_screen_door(fur_.screen_door);
    const auto bytes = static_cast<int64_t>(fur->bytes());
    const auto limit = static_cast<int64_t>(options_.memory_limit);
    if (limit > 0 && ledger.budgeted() + bytes > limit) continue;
    fur->renumber(part(chunk), chunk);
    residency_->adopt(chunk, std::move(fur), static_cast<size_t>(bytes));
  }
}

KeptChunk ResidentChunks::release(uint32_t chunk, MemoryLedger& ledger) {
  KeptChunk kept;
  if (!boxes_.in_fur_tree(chunk)) return kept;
  kept.fur.reset(static_cast<FurChunk*>(residency_->release(chunk).release()));
  if (kept.fur)
    kept.charge = MemoryCharge(ledger, MemoryTag::kChunks, static_cast<int64_t>(kept.fur->bytes()));
  kept.bounds = boxes_.take_given(chunk);
  kept.learned = boxes_.take_learned(chunk);
  return kept;
}

size_t ResidentChunks::reserve_bytes(uint32_t chunk) const {
  ChunkCounts counts = grower_.counts(chunk);
  if (is_stored(chunk)) {
    return options_.file->bytes_bound(chunk) + (fur_.min_width ? WidenedFur::bytes_bound(counts.strands) : 0);
  }
  const size_t build_peak = kPage * size_t(build_pages_[chunk].load(std::memory_order_relaxed));
  const bool fur = boxes_.in_fur_tree(chunk);
  if (build_peak > 0)
    return fur ? FurChunk::bytes_bound(counts, build_peak) : EmbreeChunk::bytes_bound(counts, build_peak);
  if (fur) return FurChunk::bytes_bound(counts, fur_);
  if (boxes_.may_learn(chunk))
    counts.growth_bytes = std::max(counts.growth_bytes, part_bounds_scratch(counts));
  return EmbreeChunk::bytes_bound(counts);
}

Grower::Grown ResidentChunks::grow(uint32_t chunk) {
  // Only one thread at a time grows a given chunk, so no other thread stores its boxes.
  const bool learns = boxes_.may_learn(chunk) && !boxes_.learned(chunk);
  if (is_stored(chunk)) {
    const auto warn = [this](const std::string& line) { progress_.warn(line); };
    if (std::unique_ptr<FurChunk> fur = options_.file->read(chunk, warn, pool_.get())) {
      if (learns) boxes_.learn(chunk, fur->part_bounds(ChunkBoxes::learned_parts(fur->segment_count())));
      if (fur_.min_width) fur->widen(*fur_.min_width);
      const size_t bytes = fur->bytes();
      return {std::move(fur), bytes};
    }
    // The chunk is no longer in the file: growing it needs more memory than was estimated for reading it.
    const size_t needed = reserve_bytes(chunk);
    if (needed > options_.file->bytes_bound(chunk)) return {nullptr, needed};
  }
  ChunkContents contents = grower_.grow(chunk);
  PELAGE_CHECK(contents.part == part(chunk));
  std::unique_ptr<ChunkGeometry> unit;
  if (boxes_.in_fur_tree(chunk)) {
    unit = grow_fur(chunk, std::move(contents), learns);
  } else {
    ChunkBounds measured;
    if (learns) measured = part_bounds(contents, ChunkBoxes::kPrimitivesPerPart, ChunkBoxes::kMaxParts);
    unit = std::make_unique<EmbreeChunk>(std::move(contents), chunk, grower_.scale(chunk).widest,
                                         options_.chunk, device_, patterns_);
    if (learns) boxes_.learn(chunk, measured);
  }
  const size_t bytes = unit->bytes();
  build_pages_[chunk].store(static_cast<uint32_t>(unit->build_peak_bytes() / kPage + 1),
                            std::memory_order_relaxed);
  return {std::move(unit), bytes};
}

std::unique_ptr<FurChunk> ResidentChunks::grow_fur(uint32_t chunk, ChunkContents contents, bool learns) {
  auto fur = std::make_unique<FurChunk>(std::move(contents), chunk, FurGrid(grower_.scale(chunk)), fur_);
  if (fur_.min_width) fur->widen(*fur_.min_width);
  if (learns) {
    const size_t parts = options_.eager ? 1 : ChunkBoxes::learned_parts(fur->segment_count());
    boxes_.learn(chunk, fur->part_bounds(parts));
  }
  return fur;
}

}  // namespace pelage
