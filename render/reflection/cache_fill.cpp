// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/reflection/reflection_cache_test.cpp.
#include "render/reflection/cache_fill.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/memory_budget.h"
#include "render/frame/tile_pass.h"

namespace pelage {
namespace {

constexpr int kSide = 16;      // of a tile, in pixels
constexpr size_t kBatch = 64;  // tiles whose tables are added up at once
/// Fraction of `render.memory` that the cache may take, unless `gather.memory` is set: 1 / kMemoryShare.
constexpr int64_t kMemoryShare = 8;

double paths_per_pixel(const RenderParams& render) {
  return double{render.gather.cache_paths} * render.samples;
}

/// Upper bound of the memory of the cache.
int64_t max_bytes(const RenderScene& scene) {
  const double paths = std::ceil(paths_per_pixel(scene.render) * scene.image.width * scene.image.height);
  const auto cells = static_cast<size_t>(paths) * std::tuple_size_v<CellPath>;
  return static_cast<int64_t>(ReflectionTable::max_bytes(cells, scene.lights.size()));
}

int64_t limit_of(const RenderScene& scene) {
  const auto own = static_cast<int64_t>(scene.render.gather.memory.bytes);
  const auto all = static_cast<int64_t>(scene.render.memory.bytes);
  const int64_t limit = own > 0 ? own : all / kMemoryShare;
  return limit > 0 ? std::min(limit, max_bytes(scene)) : max_bytes(scene);
}

}  // namespace

MemoryCharge CacheFill::reserve(const RenderScene& scene, const Job& job) {
  return pelage::reserve(job.ledger, MemoryTag::kReflectionCache, limit_of(scene), "the reflection cache");
}

CacheFill::CacheFill(const RenderScene& scene, const Accel& accel, bool splatted, const PathOptions& options)
    : scene_(scene),
      shading_(scene),
      camera_(scene, accel, splatted),
      paths_(scene, accel, shading_, camera_, options) {}

void CacheFill::check_room(int64_t bytes) const {
  const int64_t limit = limit_of(scene_);
  if (bytes <= limit) return;
  throw Error(ErrorKind::kMemory,
              fmt::format("the reflection cache needs more than {}; render.gather.memory: {}M suffices, "
                          "and so does render.gather.cache: false",
                          memory_text(limit), (max_bytes(scene_) >> 20) + 1));
}

void CacheFill::run(MemoryCharge reserved, const Job& job, const Stopwatch& clock,
                    std::optional<ReflectionCache>& cache) {
  const size_t lights = scene_.lights.size();
  const std::vector<Tile> tiles = tiles_along_curve(scene_.image.width, scene_.image.height, kSide);
  const int columns = (scene_.image.width + kSide - 1) / kSide;
  const auto place = [&](const Tile& tile) {
    return static_cast<size_t>(tile.y0 / kSide * columns + tile.x0 / kSide);
  };
  std::vector<ReflectionTable> tables(tiles.size());
  ReflectionTable sum(lights);
  scratch_ = std::vector<ReflectionPaths::Scratch>(static_cast<size_t>(job.workers.thread_count()));
  job.progress.begin("reflection cache", static_cast<double>(tiles.size()));
  for (size_t first = 0; first < tiles.size(); first += kBatch) {
    const auto begin = tiles.begin() + static_cast<std::ptrdiff_t>(first);
    const std::vector<Tile> batch(
        begin, begin + static_cast<std::ptrdiff_t>(std::min(kBatch, tiles.size() - first)));
    const PassEnd end = trace_tiles(
        batch, job, clock, std::numeric_limits<double>::infinity(), [&](const Tile& tile, int worker) {
          ReflectionPaths::Scratch& scratch = scratch_[static_cast<size_t>(worker)];
          const TileTimer timer(scratch.costs);
          scratch.thread.worker = worker;
          ReflectionTable& table = tables[place(tile)];
          table = ReflectionTable(lights);
          return paths_.trace(tile, paths_per_pixel(scene_.render), job, scratch, table);
        });
    if (end != PassEnd::kDone) break;
    int64_t bytes = 0;
    for (const Tile& tile : batch) {
      bytes += static_cast<int64_t>(tables[place(tile)].bytes());
      sum.add(std::exchange(tables[place(tile)], ReflectionTable()));
    }
    check_room(bytes + static_cast<int64_t>(sum.bytes()));
    job.progress.advance(static_cast<double>(batch.size()));
  }
  job.progress.end();
  if (!job.progress.cancelled()) {
    reserved = {};
    const auto bytes = static_cast<int64_t>(sum.bytes());
    MemoryCharge charge(job.ledger, MemoryTag::kReflectionCache, bytes);
    cells_ = static_cast<int64_t>(sum.size());
    cache.emplace(scene_, std::move(sum), std::move(charge));
  }
}

TileCosts CacheFill::costs() const {
  TileCosts all;
  for (const auto& scratch : scratch_) all += scratch.costs;
  return all;
}

void CacheFill::add_to(FrameStatistics& statistics) const {
  for (const auto& scratch : scratch_) {
    statistics.trace += scratch.thread.counts;
    statistics.reflections.paths += scratch.added;
  }
  statistics.reflections.cells += cells_;
  statistics.rays += costs().rays.counts();
}

}  // namespace pelage
