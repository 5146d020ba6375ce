// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/ledger.h"
#include "render/reflection/reflection_slots.h"
#include "render/scene/frame_scene.h"

namespace pelage {

/// The order in which the paths that fill the reflection cache are traced: all tiles of the picture in
/// several rounds. Each round traces a part of the paths of each pixel, so that the cells of a tile need
/// little memory.
struct CacheRounds {
  static constexpr int kSide = 16;  ///< of a tile, in pixels

  uint32_t count = 0;
  double paths = 0;  ///< per pixel and round, on average

  explicit CacheRounds(const RenderParams& render);
  /// Returns the max count of cells that the paths of a tile add in one round.
  size_t cells_of_tile() const;
};

/// How the reflection cache of a picture is filled within some memory. The plan changes no pixel: it decides
/// only how many cells are filled at once, and so how often the paths are traced.
struct CachePlan {
  /// Max count of cells of the finished cache. Depends on the picture alone.
  size_t max_cells = 0;
  uint32_t slices = 1;  ///< count of slices (CellRange); more if some have too many cells
  size_t room = 0;      ///< cells of one slice, at most
  size_t batch = 0;     ///< tiles whose paths are added up at once
  int64_t bytes = 0;    ///< upper bound of the memory while the cache is filled, and after

  /// Count of slices of the smallest plan.
  static constexpr uint32_t kMostSlices = 32;

  ReflectionSlots::Density density() const {
    return slices == 1 ? ReflectionSlots::Density::kFast : ReflectionSlots::Density::kSmall;
  }
  /// Returns the plan with this count of slices.
  static CachePlan with_slices(const FrameScene& scene, uint32_t slices);
  /// Returns the plan with the fewest slices that fits `render.gather.memory` or, by default, a quarter of
  /// what the ledger leaves. If none fits, returns the smallest plan. Throws Error (kMemory) if that exceeds
  /// `render.gather.memory`.
  static CachePlan fitting(const FrameScene& scene, const MemoryLedger& ledger);
};

}  // namespace pelage
