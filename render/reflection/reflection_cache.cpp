// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/reflection_cache.h"

#include <utility>

namespace pelage {

ReflectionCache::ReflectionCache(const FrameScene& scene, ReflectionSlots cells, MemoryCharge reserved,
                                 MemoryLedger& ledger)
    : keys_(scene), slots_(std::move(cells)) {
  reserved = {};
  charge_ = MemoryCharge(ledger, MemoryTag::kReflectionCache, static_cast<int64_t>(slots_.bytes()));
}

ReflectionSlots::Radiance ReflectionCache::find(const Ray& ray, const Hit& hit,
                                                const HitGeometry& hit_geometry) const {
  const std::optional<CellPath> cells = keys_.of(ray, hit, hit_geometry);
  if (!cells) return {};
  for (uint32_t level = 0; level < cells->size(); ++level) {
    if (const auto radiance = slots_.find((*cells)[level], level)) return radiance;
  }
  return {};
}

}  // namespace pelage
