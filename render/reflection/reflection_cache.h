// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/job.h"
#include "base/ledger.h"
#include "render/frame/tile_costs.h"
#include "render/reflection/cell_keys.h"
#include "render/reflection/reflection_paths.h"
#include "render/reflection/reflection_slots.h"
#include "render/reflection/reflection_table.h"

namespace pelage {

/// Means of the radiance that surfaces reflect towards indirect rays, by cell (see CellKeys) and light. The
/// cache is made from whole paths of the whole picture before the first tile is rendered, and does not change
/// afterwards. So a lookup never waits, and its result depends only on the scene.
///
/// Thread safety: const members may be called from any thread.
class ReflectionCache {
 public:
  /// Keeps a reference to `scene`. `table`: without finish(). `reserved`: ends here; it must cover the table
  /// and the cells arranged for reading.
  ReflectionCache(const RenderScene& scene, ReflectionTable table, MemoryCharge reserved,
                  MemoryLedger& ledger);

  /// Returns the mean radiance, by light, that the hit of a ray reflects against the ray. Empty where too few
  /// paths arrived.
  ReflectionSlots::Radiance find(const Ray& ray, const Hit& hit, const HitGeometry& met) const;

 private:
  CellKeys keys_;
  ReflectionSlots slots_;
  MemoryCharge charge_;
};

}  // namespace pelage
