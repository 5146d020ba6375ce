// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/ledger.h"
#include "render/reflection/cell_keys.h"
#include "render/reflection/reflection_slots.h"

namespace pelage {

/// Means of the radiance that surfaces reflect towards indirect rays, by cell (see CellKeys) and light,
/// without the light that shadow rays from these surfaces find (see ReflectionPaths). The cache is made from
/// whole paths of the whole picture before the first tile is rendered, and does not change afterwards. So a
/// lookup never waits, and its result depends only on the scene.
///
/// Thread safety: const members may be called from any thread.
class ReflectionCache {
 public:
  /// PathState::vertex at which paths read the cache: their third surface. The
  /// earlier, the fewer rays, but the more light is blurred by cells (docs/lab/GATHER.md).
  static constexpr uint32_t kVertex = 2;
  /// Min count of paths for an estimate, in a cell of the largest size.
  static constexpr uint32_t kFewestPaths = 8;

  /// Keeps a reference to `scene`. `reserved`: covers the memory of `cells` until the cache charges it
  /// itself.
  ReflectionCache(const FrameScene& scene, ReflectionSlots cells, MemoryCharge reserved,
                  MemoryLedger& ledger);

  /// Returns the mean radiance, by light, that the hit of a ray reflects against the ray. Empty where too few
  /// paths arrived.
  ReflectionSlots::Radiance find(const Ray& ray, const Hit& hit, const HitGeometry& hit_geometry) const;
  size_t bytes() const { return slots_.bytes(); }

 private:
  CellKeys keys_;
  ReflectionSlots slots_;
  MemoryCharge charge_;
};

}  // namespace pelage
