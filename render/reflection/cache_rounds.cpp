// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/cache_rounds.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "render/reflection/cell_keys.h"

namespace pelage {
namespace {

constexpr double kAtOnce = 4;  // paths per pixel and round, at most
/// More samples add no more paths: cells have enough, and the picture must begin some time.
constexpr int kMostSamples = 1024;

double paths_per_pixel(const RenderParams& render) {
  return double{render.gather.cache_paths} * std::min(render.samples, kMostSamples);
}

}  // namespace

CacheRounds::CacheRounds(const RenderParams& render)
    : count(static_cast<uint32_t>(std::max(1.0, std::ceil(paths_per_pixel(render) / kAtOnce)))),
      paths(paths_per_pixel(render) / count) {}

size_t CacheRounds::cells_of_tile() const {
  return static_cast<size_t>(std::ceil(paths * kSide * kSide + 1)) * std::tuple_size_v<CellPath>;
}

}  // namespace pelage
