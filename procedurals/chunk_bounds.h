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
  kUser,          ///< conservative, scaled by a factor about its centre: may lose pixels
  kConservative,  ///< roots, longest strand, each operator's reach
  kExact,         ///< grown once, measured, discarded; for the whole frame interval
  kExactShutter,  ///< the same, for the open shutter only
  kLinear,        ///< the same, two boxes linear in time
};
template <>
struct EnumNames<BoundingStrategy> {
  static constexpr const char* names[] = {"none", "user", "conservative", "exact", "exact-shutter", "linear"};
};

/// Boxes of one chunk, one per part: a group of neighbouring segments, or all of it. The box of a part at key
/// k is boxes[part * keys + k]. With one key it contains the part over the whole span. With two keys they are
/// the boxes at shutter open and close, and the box interpolated linearly to a ray's time contains the part
/// at that time. Measured chunks also have fine boxes, which avoid growing a chunk for rays that miss its
/// contents.
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

/// Tightness of boxes: sums of surface areas, averaged over their keys where they move.
struct BoundsArea {
  double chunks = 0;  ///< of the box around each chunk
  double parts = 0;   ///< of the boxes of all parts

  BoundsArea& operator+=(const BoundsArea& other) {
    chunks += other.chunks;
    parts += other.parts;
    return *this;
  }
};
BoundsArea area_of(const ChunkBounds& chunk);

}  // namespace pelage
