// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/reflection_cache.h"

#include <utility>

namespace pelage {
namespace {

/// Fewer paths are too few for an estimate, even in a cell of the largest size.
constexpr uint32_t kFew = 8;
/// How many of its own paths the estimate of the larger cell around a cell replaces. A cell with few paths is
/// noisy, and one with many needs no help.
constexpr float kBlend = 8;

}  // namespace

ReflectionCache::ReflectionCache(const RenderScene& scene, ReflectionTable table, MemoryCharge charge)
    : keys_(scene), table_(std::move(table)), charge_(std::move(charge)) {
  table_.finish(kBlend);
}

const Rgb* ReflectionCache::find(const Ray& ray, const Hit& hit, const HitGeometry& met) const {
  const std::optional<CellPath> cells = keys_.of(ray, hit, met);
  if (!cells) return nullptr;
  const size_t largest = table_.find(cells->back());
  if (largest == table_.size() || table_.cell(largest).paths < kFew) return nullptr;
  for (const uint64_t key : *cells) {
    const size_t cell = table_.find(key);
    if (cell < table_.size()) return table_.radiance(cell);
  }
  return nullptr;
}

}  // namespace pelage
