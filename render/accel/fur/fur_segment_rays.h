// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "render/accel/fur/fur_hit.h"
#include "render/accel/fur/fur_tree.h"
#include "render/accel/fur/snapped_strands.h"

namespace pelage {

/// Intersects many rays with one segment of a fur tree without motion, several rays at a time.
struct FurSegmentRays {
  static constexpr size_t kMax = 16;  ///< max count of rays in one call

  /// Stores the first hit of each ray in `hits`, with distances in scene units. Returns the rays, as bits,
  /// for which this cannot be decided: test them with closest_fur_at(), which gives the same bits for all
  /// others. `segment`: the segment as it is in the tree, in grid units. Rays must start on no strand.
  static uint32_t closest(const FurTreeView& tree, const SnappedSegment& segment, uint32_t number,
                          std::span<const Ray* const> rays, FurHit* hits);
};

}  // namespace pelage
