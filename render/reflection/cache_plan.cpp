// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/cache_plan.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "base/error.h"
#include "base/memory_budget.h"
#include "render/reflection/cell_keys.h"
#include "render/reflection/reflection_slots.h"
#include "render/reflection/reflection_table.h"

namespace pelage {
namespace {

constexpr double kAtOnce = 4;  // paths per pixel and round, at most
/// More samples add no more paths: cells have enough, and the picture must begin some time.
constexpr int kMostSamples = 1024;

/// With adaptive sampling, most pixels get far fewer samples than the max.
constexpr int kMostAdaptiveSamples = 64;

double paths_per_pixel(const RenderParams& render) {
  const int most = render.adaptive ? kMostAdaptiveSamples : kMostSamples;
  return double{render.gather.cache_paths} * std::min(render.samples, most);
}

constexpr size_t kMostTiles = 32;  // whose paths are added up at once
/// Max count of cells: per pixel, but at least kFewestCells and at most kMostCells. Beyond, the smallest
/// cells are dropped. So the limit depends on the picture alone. In large pictures, cells of twice the size
/// are still small on the animal.
constexpr size_t kCellsPerPixel = 4, kFewestCells = size_t{1} << 15, kMostCells = size_t{1} << 20;
/// Min room of a slice: more than the cells in one largest cell, of which a slice cannot have less. These are
/// 8 x 8 x 8 cubes with up to 7 parts of strands each, and those of twice the size.
constexpr size_t kMinRoom = 4096;
/// By default, the cache takes at most 1 / kShares of the memory that is left, if slices make that possible.
constexpr int64_t kShares = 4;

size_t cache_tile_count(const FrameScene& scene) {
  const auto across = [](int side) {
    return static_cast<size_t>((side + CacheRounds::kSide - 1) / CacheRounds::kSide);
  };
  return across(scene.image.width) * across(scene.image.height);
}

size_t max_cells(const FrameScene& scene) {
  const size_t pixels = static_cast<size_t>(scene.image.width) * static_cast<size_t>(scene.image.height);
  const CacheRounds rounds(scene.render);
  // Each tile of each round may round its count of paths up.
  const double paths = std::ceil(rounds.paths * static_cast<double>(rounds.count * pixels)) +
                       static_cast<double>(cache_tile_count(scene) * rounds.count);
  const size_t limit = std::clamp(kCellsPerPixel * pixels, kFewestCells, kMostCells);
  return static_cast<size_t>(std::min(static_cast<double>(limit), paths * std::tuple_size_v<CellPath>));
}

}  // namespace

CacheRounds::CacheRounds(const RenderParams& render)
    : count(static_cast<uint32_t>(std::max(1.0, std::ceil(paths_per_pixel(render) / kAtOnce)))),
      paths(paths_per_pixel(render) / count) {}

size_t CacheRounds::cells_of_tile() const {
  return static_cast<size_t>(std::ceil(paths * kSide * kSide + 1)) * std::tuple_size_v<CellPath>;
}

CachePlan CachePlan::with_slices(const FrameScene& scene, uint32_t slices) {
  const size_t lights = scene.sources();
  CachePlan plan;
  plan.max_cells = pelage::max_cells(scene);
  plan.slices = slices;
  plan.room = slices == 1 ? plan.max_cells
                          : std::min(plan.max_cells, std::max(plan.max_cells / slices * 5 / 4, kMinRoom));
  plan.batch = std::min(std::max<size_t>(kMostTiles / slices, 1), cache_tile_count(scene));
  const size_t added = plan.batch * CacheRounds(scene.render).cells_of_tile();
  const size_t tables = ReflectionTable::max_bytes(added, lights);
  const size_t slots = ReflectionSlots::bytes(plan.max_cells, lights, plan.density());
  const size_t table = ReflectionTable::max_bytes(plan.room + added, lights);
  // The slots of a single slice are made after its paths were added up; those of several slices before.
  plan.bytes = static_cast<int64_t>(table + (slices == 1 ? std::max(tables, slots) : tables + slots));
  return plan;
}

CachePlan CachePlan::fitting(const FrameScene& scene, const MemoryLedger& ledger) {
  const auto limit = static_cast<int64_t>(scene.render.gather.memory.bytes);
  CachePlan plan;
  for (uint32_t slices = 1; slices <= kMostSlices; slices *= 2) {
    plan = with_slices(scene, slices);
    // Without a limit of its own, the cache leaves most of the memory to what comes after.
    if (limit == 0 ? has_room(ledger, kShares * plan.bytes)
                   : plan.bytes <= limit && has_room(ledger, plan.bytes))
      return plan;
  }
  if (limit > 0 && plan.bytes > limit) {
    throw Error(ErrorKind::kMemory,
                fmt::format("the reflection cache needs {} or more, but render.gather.memory is {}; {}M "
                            "suffices, and so does render.gather.cache: false",
                            memory_text(plan.bytes), memory_text(limit), (plan.bytes >> 20) + 1));
  }
  return plan;
}

}  // namespace pelage
