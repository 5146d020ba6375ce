// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "procedurals/bounds/segment_cell_bounds.h"
#include "render/accel/ray_slabs.h"

namespace pelage {

/// Intersection of a ray with the cell bounds of a chunk.
struct SegmentCellHits {
  /// Distance at which the ray enters the first box; infinity if the ray intersects none.
  float entry = std::numeric_limits<float>::infinity();
  uint32_t boxes = 0;  ///< number of intersected boxes; incomplete unless `all` was set
};

/// Finds the first cell bound that a ray intersects in front of `far`. With `all`, counts all cell bounds
/// that the ray intersects in front of `far`. Adds the number of tested boxes to `tests`. Boxes are enlarged
/// by `margin` on every side.
SegmentCellHits intersect_segment_cell_bounds(const SegmentCellBounds& boxes, const RaySlabs& ray, float far,
                                              bool all, int64_t& tests, float margin = 0);

}  // namespace pelage
