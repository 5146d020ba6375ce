// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "procedurals/chunk_bounds.h"
#include "render/accel/chunk_grower.h"
#include "render/accel/ray_slabs.h"

namespace pelage {

/// Boxes of about `segments_per_part` neighbouring segments or triangles each, at most `max_parts`, over the
/// whole shutter; linear in time when there is motion. Parts ignore strands: the box of pieces of many
/// strands is much smaller than the box of a few whole strands.
ChunkBounds part_bounds(const ChunkContents& contents, size_t segments_per_part, size_t max_parts);
/// Enlarges the boxes at shutter open and close so that the interpolated box contains `inside` at `time`.
void hold_at(Box3f& open, Box3f& close, const Box3f& inside, float time);
/// Moves all sides of all boxes outward.
void widen(ChunkBounds& bounds, float margin);
/// Max temporary memory of part_bounds().
size_t part_bounds_scratch(const ChunkCounts& counts);

/// The boxes of one chunk, ready for ray tracing. Immutable.
class PartBoxes {
 public:
  explicit PartBoxes(const ChunkBounds& bounds);

  /// Entry distance of the first box that the ray intersects before `far`; infinity when there is none.
  float enter(const RaySlabs& ray, float far) const {
    float nearest = std::numeric_limits<float>::infinity();
    for (size_t i = 0; i < boxes_.size(); ++i) {
      Four enter, leave;
      const auto met = ray.intersect(boxes_[i], motions_.empty() ? nullptr : &motions_[i], far, enter, leave);
      for (size_t lane = 0; lane < 4; ++lane) {
        if (met[lane]) nearest = std::min(nearest, enter[lane]);
      }
    }
    return nearest;
  }
  size_t count() const { return count_; }
  /// The original boxes.
  ChunkBounds bounds() const;
  static size_t bytes_bound(size_t parts, bool moving) {
    return sizeof(PartBoxes) + (parts + 3) / 4 * sizeof(FourBoxes) * (moving ? 2 : 1);
  }

 private:
  std::vector<FourBoxes> boxes_;
  std::vector<FourBoxes> motions_;  // one per box, or empty
  size_t count_ = 0;
};

}  // namespace pelage
