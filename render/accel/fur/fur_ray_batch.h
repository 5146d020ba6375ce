// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "render/accel/fur/fur_ray.h"
#include "render/accel/fur/fur_segment_rays.h"

namespace pelage {

/// Rays in grid units, one per lane. FurRay has the same numbers for one ray.
struct FurRayBatch {
  static constexpr size_t kMax = FurSegmentRays::kMax;

  /// Converts up to kMax rays.
  FurRayBatch(const FurTreeView& tree, std::span<const Ray* const> rays);

  alignas(64) float direction[3][kMax] = {};  ///< 0 beyond the last ray
  alignas(64) double origin[3][kMax] = {};
  alignas(64) float point_error_bound[kMax] = {}, near[kMax] = {}, far[kMax] = {};
  uint32_t axis[3];     ///< i, j, k, see FurRay
  uint32_t others = 0;  ///< lanes, as bits, of rays that are not valid or have another axis k
  size_t count = 0;
};

}  // namespace pelage
