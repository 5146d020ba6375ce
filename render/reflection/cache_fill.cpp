// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/reflection/reflection_cache_test.cpp.
#include "render/reflection/cache_fill.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/memory_budget.h"
#include "render/frame/tile_pass.h"

namespace pelage {
namespace {

constexpr int kSide = 16;      // of a tile, in pixels
constexpr size_t kBatch = 32;  // tiles whose tables are added up at once
constexpr double kAtOnce = 4;  // paths per pixel that a tile adds to a table at once
/// Max count of cells: per pixel, but at least kFewestCells and at most kMostCells. Beyond, the smallest
/// cells are dropped. So the limit depends on the picture alone. In large pictures, cells of twice the size
/// are still small on the animal.
constexpr size_t kCellsPerPixel = 4, kFewestCells = size_t{1} << 15, kMostCells = size_t{1} << 20;

/// More samples add no more paths: cells have enough, and the picture must begin some time.
constexpr int kMostSamples = 1024;
/// The part of `render.time_limit` after which cells must do with the paths that they have.
constexpr double kTimeShare = 0.25;

double paths_per_pixel(const RenderParams& render) {
  return double{render.gather.cache_paths} * std::min(render.samples, kMostSamples);
}

/// How many times tiles are visited, so that the tables of a batch stay small.
uint32_t rounds(const RenderParams& render) {
  return static_cast<uint32_t>(std::max(1.0, std::ceil(paths_per_pixel(render) / kAtOnce)));
}

size_t tile_count(const RenderScene& scene) {
  const auto across = [](int side) { return static_cast<size_t>((side + kSide - 1) / kSide); };
  return across(scene.image.width) * across(scene.image.height);
}

/// Max count of cells that one batch of tiles adds.
size_t cells_of_batch(const RenderScene& scene) {
  const double paths = paths_per_pixel(scene.render) / rounds(scene.render) * kSide * kSide + 1;
  return std::min(kBatch, tile_count(scene)) * static_cast<size_t>(std::ceil(paths)) *
         std::tuple_size_v<CellPath>;
}

size_t max_cells(const RenderScene& scene) {
  const size_t pixels = static_cast<size_t>(scene.image.width) * static_cast<size_t>(scene.image.height);
  // Each tile of each round may round its count of paths up.
  const double paths = std::ceil(paths_per_pixel(scene.render) * static_cast<double>(pixels)) +
                       static_cast<double>(tile_count(scene) * rounds(scene.render));
  const size_t limit = std::clamp(kCellsPerPixel * pixels, kFewestCells, kMostCells);
  return static_cast<size_t>(std::min(static_cast<double>(limit), paths * std::tuple_size_v<CellPath>));
}

/// Upper bound of the memory of the cache while it is filled.
int64_t max_bytes(const RenderScene& scene) {
  const size_t lights = scene.lights.size(), batch = cells_of_batch(scene);
  constexpr size_t kDoubling = 3;  // vectors of the tables of tiles grow: the old array beside the new one
  const size_t tables = kDoubling * ReflectionTable::max_bytes(batch, lights);
  const size_t slots = ReflectionSlots::max_bytes(max_cells(scene), lights);  // after those tables
  return static_cast<int64_t>(ReflectionTable::max_bytes(max_cells(scene) + batch, lights) +
                              std::max(tables, slots));
}

}  // namespace

MemoryCharge CacheFill::reserve(const RenderScene& scene, const Job& job) {
  const auto limit = static_cast<int64_t>(scene.render.gather.memory.bytes);
  const int64_t needed = max_bytes(scene);
  if (limit > 0 && needed > limit) {
    throw Error(ErrorKind::kMemory,
                fmt::format("the reflection cache may need {}, but render.gather.memory is {}; {}M suffices, "
                            "and so does render.gather.cache: false",
                            memory_text(needed), memory_text(limit), (needed >> 20) + 1));
  }
  return pelage::reserve(job.ledger, MemoryTag::kReflectionCache, needed,
                         "the reflection cache (render.gather.cache: false needs none)");
}

CacheFill::CacheFill(const RenderScene& scene, const Accel& accel, bool splatted, const PathOptions& options)
    : scene_(scene),
      shading_(scene, options.known),
      camera_(scene, accel, splatted),
      paths_(scene, accel, shading_, camera_, options) {}

void CacheFill::run(MemoryCharge reserved, const Job& job, const Stopwatch& clock,
                    std::optional<ReflectionCache>& cache) {
  const std::vector<Tile> tiles = tiles_along_curve(scene_.image.width, scene_.image.height, kSide);
  ReflectionTable sum(scene_.lights.size(), max_cells(scene_) + cells_of_batch(scene_));
  scratch_ = std::vector<ReflectionPaths::Scratch>(static_cast<size_t>(job.workers.thread_count()));
  const uint32_t count = rounds(scene_.render);
  job.progress.begin("reflection cache", static_cast<double>(tiles.size()) * count);
  PassEnd end = PassEnd::kDone;
  for (uint32_t round = 0; round < count && end == PassEnd::kDone; ++round) {
    for (size_t first = 0; first < tiles.size() && end == PassEnd::kDone; first += kBatch) {
      const auto begin = tiles.begin() + static_cast<std::ptrdiff_t>(first);
      const size_t size = std::min(kBatch, tiles.size() - first);
      end = trace_batch({begin, begin + static_cast<std::ptrdiff_t>(size)}, round, job, clock, sum);
      job.progress.advance(static_cast<double>(size));
    }
  }
  job.progress.end();
  if (job.progress.cancelled()) return;
  cells_ = static_cast<int64_t>(sum.size());
  cache.emplace(scene_, std::move(sum), std::move(reserved), job.ledger);
}

/// Traces the paths of a round of some tiles, and adds them to `sum` in the order of the tiles.
PassEnd CacheFill::trace_batch(const std::vector<Tile>& batch, uint32_t round, const Job& job,
                               const Stopwatch& clock, ReflectionTable& sum) {
  const int columns = (scene_.image.width + kSide - 1) / kSide;
  const auto place = [&](const Tile& tile) { return tile.y0 / kSide * columns + tile.x0 / kSide; };
  std::map<int, ReflectionTable> tables;
  for (const Tile& tile : batch) tables.emplace(place(tile), ReflectionTable(scene_.lights.size()));
  const ReflectionPaths::Share share{round, paths_per_pixel(scene_.render) / rounds(scene_.render)};
  const float limit_s = scene_.render.time_limit;
  const double end_s = limit_s > 0 ? kTimeShare * limit_s : std::numeric_limits<double>::infinity();
  const PassEnd end = trace_tiles(batch, job, clock, end_s, [&](const Tile& tile, int worker) {
    ReflectionPaths::Scratch& scratch = scratch_[static_cast<size_t>(worker)];
    const TileTimer timer(scratch.costs);
    scratch.thread.worker = worker;
    return paths_.trace(tile, share, job, scratch, tables.at(place(tile)));
  });
  if (end != PassEnd::kDone) return end;
  for (const Tile& tile : batch) sum.add(tables.at(place(tile)));
  while (sum.size() > max_cells(scene_)) sum.drop_smallest();
  return end;
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
