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

ReflectionSlots slots_of(ReflectionTable table, size_t lights) {
  table.finish(kBlend);
  return {table, lights, kFew};
}

}  // namespace

ReflectionCache::ReflectionCache(const RenderScene& scene, ReflectionTable table, MemoryCharge reserved,
                                 MemoryLedger& ledger)
    : keys_(scene), slots_(slots_of(std::move(table), scene.lights.size())) {
  reserved = {};
  charge_ = MemoryCharge(ledger, MemoryTag::kReflectionCache, static_cast<int64_t>(slots_.bytes()));
}

ReflectionSlots::Radiance ReflectionCache::find(const Ray& ray, const Hit& hit,
                                                const HitGeometry& met) const {
  const std::optional<CellPath> cells = keys_.of(ray, hit, met);
  if (!cells) return {};
  for (const uint64_t key : *cells) {
    if (const auto radiance = slots_.find(key)) return radiance;
  }
  return {};
}

}  // namespace pelage
