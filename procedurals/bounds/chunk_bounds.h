// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "base/value_readers.h"
#include "base/vector.h"
#include "procedurals/bounds/segment_cell_bounds.h"

namespace pelage {

/// How the boxes of a chunk are determined before the chunk is grown for use (`render.bounds`).
enum class BoundingStrategy {
  kNone,          ///< no boxes, because all chunks are grown at the start
  kConservative,  ///< computed from the roots, the longest strand and the reach of each operator
  kExact,  ///< the chunk is grown, measured and discarded; boxes are valid for the whole frame interval
  kExactShutter,  ///< like kExact, but boxes are valid only while the shutter is open
  kLinear,        ///< like kExactShutter, but with boxes at shutter open and close, interpolated linearly
};
template <>
struct EnumNames<BoundingStrategy> {
  static constexpr const char* names[] = {"none", "conservative", "exact", "exact-shutter", "linear"};
};

/// Boxes of one chunk. A chunk has one or more parts; a part is a group of neighbouring segments, or the
/// whole chunk. The box of a part at key k is boxes[part * keys + k]. With one key, the box contains the part
/// during the whole time span. With two keys, the boxes are at shutter open and close; the box interpolated
/// linearly to the time of a ray contains the part at this time. Measured chunks also have cell bounds. A ray
/// that misses all cell bounds does not hit the chunk, so the chunk need not be grown for this ray.
struct ChunkBounds {
  int keys = 1;
  std::vector<Box3f> boxes;
  SegmentCellBounds cell_bounds =
      {};  ///< together contain the chunk at each time of the shutter; may be empty

  size_t part_count() const { return boxes.size() / static_cast<size_t>(keys); }
  /// Returns the box of a part at a key.
  const Box3f& box(size_t part, int key) const {
    return boxes[part * static_cast<size_t>(keys) + static_cast<size_t>(key)];
  }
  /// Returns bounds with one part that contains all parts, and with the same cell bounds.
  ChunkBounds in_one_part() &&;
  /// Returns a box that contains all parts at all times; an empty box for an empty chunk.
  Box3f whole() const {
    Box3f all;
    for (const Box3f& box : boxes) all.extendBy(box);
    return all;
  }
};

/// Total surface areas of boxes, as a measure of how tight the boxes are. The area of a box with two keys is
/// the mean of its areas at both keys.
struct BoundsArea {
  double chunks = 0;  ///< area of the boxes around whole chunks
  double parts = 0;   ///< area of the boxes of all parts

  BoundsArea& operator+=(const BoundsArea& other) {
    chunks += other.chunks;
    parts += other.parts;
    return *this;
  }
};
/// Returns the areas of the boxes of one chunk.
BoundsArea area_of(const ChunkBounds& chunk);

}  // namespace pelage
