// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "base/value_readers.h"
#include "base/vector.h"
#include "procedurals/fine_boxes.h"

namespace pelage {

/// How the box of a chunk is determined before the chunk is grown (`render.bounds`).
enum class BoundingStrategy {
  kNone,          ///< not needed: everything is grown up front
  kUser,          ///< as kConservative, but scaled about its centre by a factor of the user: hair outside the
                  ///< box is lost
  kConservative,  ///< computed from the roots, the longest strand and the reach of each operator
  kExact,         ///< the chunk is grown, measured and discarded; the box holds for the whole frame interval
  kExactShutter,  ///< as kExact, but the box holds only while the shutter is open
  kLinear,        ///< as kExactShutter, with two boxes: at shutter open and close, interpolated linearly
};
template <>
struct EnumNames<BoundingStrategy> {
  static constexpr const char* names[] = {"none", "user", "conservative", "exact", "exact-shutter", "linear"};
};

/// Boxes of one chunk, one per part. A part is a group of neighbouring segments, or the whole chunk. The box
/// of a part at key k is boxes[part * keys + k]. With one key, the box contains the part over the whole span.
/// With two keys, the boxes are at shutter open and close; interpolated linearly to the time of a ray, they
/// contain the part at that time. Measured chunks also have fine boxes, so that rays that miss the contents
/// of a chunk do not grow it.
struct ChunkBounds {
  int keys = 1;
  std::vector<Box3f> boxes;
  FineBoxes fine = {};  ///< contain the whole chunk, at each time of the shutter; may be empty

  size_t part_count() const { return boxes.size() / static_cast<size_t>(keys); }
  const Box3f& box(size_t part, int key) const {
    return boxes[part * static_cast<size_t>(keys) + static_cast<size_t>(key)];
  }
  /// One part that contains all parts, with the same fine boxes.
  ChunkBounds in_one_part() &&;
  /// Contains all parts at all times; empty for an empty chunk.
  Box3f whole() const {
    Box3f all;
    for (const Box3f& box : boxes) all.extendBy(box);
    return all;
  }
};

/// Sums of surface areas, which tell how tight boxes are. The area of a moving box is the mean over its keys.
struct BoundsArea {
  double chunks = 0;  ///< area of the boxes around whole chunks
  double parts = 0;   ///< area of the boxes of all parts

  BoundsArea& operator+=(const BoundsArea& other) {
    chunks += other.chunks;
    parts += other.parts;
    return *this;
  }
};
BoundsArea area_of(const ChunkBounds& chunk);

}  // namespace pelage
