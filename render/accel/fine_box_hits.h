// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "procedurals/fine_boxes.h"
#include "render/accel/ray_slabs.h"

namespace pelage {

/// What a ray meets of the fine boxes of a chunk.
struct FineBoxHits {
  float entry =
      std::numeric_limits<float>::infinity();  ///< where it enters the first; infinity: it meets none
  uint32_t boxes = 0;                          ///< how many it meets, where that was asked for
};

/// Looks before `far` for the first of the fine boxes that a ray meets, or, with `all`, for all of them. Adds
/// to `tests` how many were looked at. Boxes are taken to be larger by `margin` on every side.
FineBoxHits intersect_fine_boxes(const FineBoxes& boxes, const RaySlabs& ray, float far, bool all,
                                 int64_t& tests, float margin = 0);

}  // namespace pelage
