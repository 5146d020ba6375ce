// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "procedurals/bounds/chunk_bounds.h"
#include "render/accel/chunk_grower.h"
#include "render/accel/ray_slabs.h"

namespace pelage {

/// Divides the contents into at most `max_parts` parts and returns the box of each part over the whole
/// shutter. With motion, the boxes are linear in time. A part has about `segments_per_part` neighbouring
/// segments or triangles, or more if the max number of parts is reached. A part may contain single segments
/// of many strands, because neighbouring segments of many strands have a much smaller box than a few whole
/// strands.
ChunkBounds part_bounds(const ChunkContents& contents, size_t segments_per_part, size_t max_parts);
/// Enlarges `open` and `close`, a part's boxes at shutter open and close, so that the box interpolated
/// linearly between them contains `inside` at `time`, which is in [0, 1].
void hold_at(Box3f& open, Box3f& close, const Box3f& inside, float time);
/// Moves all sides of all boxes outward by `margin`; leaves empty boxes unchanged.
void widen(ChunkBounds& bounds, float margin);
/// Max temporary memory of part_bounds(), in bytes.
size_t part_bounds_scratch(const ChunkCounts& counts);

/// The boxes of one chunk, ready for ray tracing. Immutable.
class PartBoxes {
 public:
  explicit PartBoxes(const ChunkBounds& bounds);

  /// Returns the distance at which the ray enters the first box that it intersects before `far`; infinity if
  /// there is none.
  float enter(const RaySlabs& ray, float far) const {
    float nearest = std::numeric_limits<float>::infinity();
    for (size_t i = 0; i < boxes_.size(); ++i) {
      Four enter, leave;
      const auto entered =
          ray.intersect(boxes_[i], motions_.empty() ? nullptr : &motions_[i], far, enter, leave);
      for (size_t lane = 0; lane < 4; ++lane) {
        if (entered[lane]) nearest = std::min(nearest, enter[lane]);
      }
    }
    return nearest;
  }
  size_t count() const { return count_; }
  /// Returns the boxes passed to the constructor; boxes at shutter close may differ by rounding.
  ChunkBounds bounds() const;
  static size_t bytes_bound(size_t parts, bool moving) {
    return sizeof(PartBoxes) + (parts + 3) / 4 * sizeof(FourBoxes) * (moving ? 2 : 1);
  }

 private:
  std::vector<FourBoxes> boxes_;
  std::vector<FourBoxes> motions_;  // displacement of boxes_ until shutter close; empty without motion
  size_t count_ = 0;
};

}  // namespace pelage
