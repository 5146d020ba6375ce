// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/cache_fill.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "base/memory_budget.h"
#include "render/reflection/cache_plan.h"

namespace pelage {
namespace {

/// How many of its own paths the estimate of the larger cell around a cell replaces. A cell with few paths is
/// noisy, and one with many needs no help.
constexpr float kBlend = 4;
/// The part of `render.time_limit` after which cells must do with the paths that they have.
constexpr double kTimeShare = 0.25;

}  // namespace

CacheFill::Memory CacheFill::reserve(const FrameScene& scene, const Job& job) {
  const CachePlan plan = CachePlan::fitting(scene, job.ledger);
  if (scene.render.gather.memory.bytes == 0)
    job.ledger.add_elastic(CachePlan::with_slices(scene, 1).bytes - plan.bytes);
  return {plan, pelage::reserve(job.ledger, MemoryTag::kReflectionCache, plan.bytes,
                                "the reflection cache (render.gather.cache: false needs none)")};
}

CacheFill::CacheFill(const FrameScene& scene, const Accel& accel, bool splatted, const PathOptions& options,
                     Memory memory)
    : scene_(scene),
      shading_(scene, options.balls),
      camera_(scene, accel, splatted),
      paths_(scene, accel, shading_, camera_, options),
      memory_(std::move(memory)),
      tiles_(tiles_along_curve(scene.image.width, scene.image.height, CacheRounds::kSide)) {}

void CacheFill::run(const Job& job, const Stopwatch& clock, std::optional<ReflectionCache>& cache) {
  const CachePlan& plan = memory_.plan;
  scratch_ = std::vector<ReflectionPaths::Scratch>(static_cast<size_t>(job.workers.thread_count()));
  if (plan.slices > 1) slots_.emplace(scene_.sources(), plan.max_cells, plan.density());
  start_s_ = clock.seconds();
  job.progress.begin("reflection cache", 1);
  CellRange range(CellRange::kAll / plan.slices);
  while (!range.is_over()) {
    const size_t batch = plan.batch * CacheRounds(scene_.render).cells_of_tile();
    ReflectionTable sum(scene_.sources(), plan.room + batch, smallest_);
    switch (fill_slice(range, job, clock, sum)) {
      case SliceEnd::kCancelled:
        return;
      case SliceEnd::kTooLarge:
        range.halve();
        break;
      case SliceEnd::kDone:
        finish_slice(range, std::move(sum));
        range.advance();
        break;
    }
  }
  job.progress.end();
  cache.emplace(scene_, std::move(*slots_), std::move(memory_.charge), job.ledger);
  counts_.bytes = static_cast<int64_t>(cache->bytes());
}

/// Adds the paths of a slice to `sum`. Ends early with kTooLarge where the slice does not fit into the plan.
CacheFill::SliceEnd CacheFill::fill_slice(const CellRange& range, const Job& job, const Stopwatch& clock,
                                          ReflectionTable& sum) {
  const CacheRounds rounds(scene_.render);
  const float limit_s = scene_.render.time_limit;
  const double end_s = limit_s > 0 ? std::lerp(start_s_, kTimeShare * limit_s, range.share_done())
                                   : std::numeric_limits<double>::infinity();
  const double total = static_cast<double>(tiles_.size()) * rounds.count;
  double done = 0;
  PassEnd end = PassEnd::kDone;
  for (uint32_t round = 0; round < rounds.count && end == PassEnd::kDone; ++round) {
    for (size_t first = 0; first < tiles_.size() && end == PassEnd::kDone; first += memory_.plan.batch) {
      const auto begin = tiles_.begin() + static_cast<std::ptrdiff_t>(first);
      const size_t size = std::min(memory_.plan.batch, tiles_.size() - first);
      end = trace_batch({begin, begin + static_cast<std::ptrdiff_t>(size)}, {round, rounds.paths, range},
                        end_s, job, clock, sum);
      drop_cells(sum);
      done += static_cast<double>(size);
      show(std::lerp(range.share_before(), range.share_done(), done / total), job);
      if (sum.size() > memory_.plan.room && range.can_halve()) return SliceEnd::kTooLarge;
    }
  }
  return job.progress.cancelled() ? SliceEnd::kCancelled : SliceEnd::kDone;
}

/// Shows that a part of all work is done, unless more was shown already: a slice may start again.
void CacheFill::show(double part, const Job& job) {
  if (part <= shown_) return;
  job.progress.advance(part - shown_);
  shown_ = part;
}

/// Traces the paths of a round of some tiles, and adds them to `sum` in the order of the tiles.
PassEnd CacheFill::trace_batch(const std::vector<Tile>& batch, const ReflectionPaths::Share& share,
                               double end_s, const Job& job, const Stopwatch& clock, ReflectionTable& sum) {
  const int columns = (scene_.image.width + CacheRounds::kSide - 1) / CacheRounds::kSide;
  const auto place = [&](const Tile& tile) {
    return tile.y0 / CacheRounds::kSide * columns + tile.x0 / CacheRounds::kSide;
  };
  const size_t room = CacheRounds(scene_.render).cells_of_tile();
  std::map<int, ReflectionTable> tables;
  for (const Tile& tile : batch)
    tables.emplace(place(tile), ReflectionTable(scene_.sources(), room, smallest_));
  const PassEnd end = trace_tiles(batch, job, clock, end_s, [&](const Tile& tile, int worker) {
    ReflectionPaths::Scratch& scratch = scratch_[static_cast<size_t>(worker)];
    const TileTimer timer(scratch.costs);
    scratch.thread.worker = worker;
    return paths_.trace(tile, share, job, scratch, tables.at(place(tile)));
  });
  if (end != PassEnd::kDone) return end;
  for (const Tile& tile : batch) sum.add(tables.at(place(tile)));
  return end;
}

/// Drops the smallest cells while there are too many in all slices. The counts of cells of the slices only
/// grow, so the level that is left in the end does not depend on the order of slices.
void CacheFill::drop_cells(ReflectionTable& sum) {
  const auto finished = [&] {
    return std::accumulate(cells_.begin() + std::min<size_t>(smallest_, cells_.size()), cells_.end(),
                           size_t{0});
  };
  while (finished() + sum.size() > memory_.plan.max_cells) {
    if (slots_) slots_->drop(smallest_);
    sum.drop_smallest();
    smallest_ = sum.smallest_level();
  }
}

/// Makes estimates of the sums of a slice, and adds them to the finished cells.
void CacheFill::finish_slice(const CellRange& range, ReflectionTable sum) {
  sum.finish(kBlend);
  for (size_t i = 0; i < sum.size(); ++i) {
    const ReflectionTable::Cell& cell = sum.cell(i);
    ++cells_[cell.level];
    if (cell.level + 1 == cells_.size()) counts_.paths += cell.paths;
  }
  if (range.is_all()) slots_.emplace(scene_.sources(), sum.size());
  slots_->add(sum, ReflectionCache::kFewestPaths);
  ++counts_.slices;
}

TileCosts CacheFill::costs() const {
  TileCosts all;
  for (const auto& scratch : scratch_) all += scratch.costs;
  return all;
}

void CacheFill::add_to(FrameStatistics& statistics) const {
  for (const auto& scratch : scratch_) scratch.add_to(statistics);
  ReflectionStatistics counts = counts_;
  for (size_t level = smallest_; level < cells_.size(); ++level)
    counts.cells += static_cast<int64_t>(cells_[level]);
  statistics.reflections += counts;
}

}  // namespace pelage
