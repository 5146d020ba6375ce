// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "base/value_readers.h"
#include "base/vector.h"
#include "procedurals/fine_boxes.h"

namespace pelage {

/// How the box of a chunk is found before anything of it is needed (`render.bounds`).
enum class BoundingStrategy {
  kNone,          ///< not needed: everything is grown up front
  kUser,          ///< conservative, scaled by a factor about its centre: may lose pixels
  kConservative,  ///< roots, longest strand, each operator's reach
  kExact,         ///< grown once, measured, dropped; the whole frame interval
  kExactShutter,  ///< the same, only while the shutter is open
  kLinear,        ///< the same, two boxes linear in time
};
template <>
struct EnumNames<BoundingStrategy> {
  static constexpr const char* names[] = {"none", "user", "conservative", "exact", "exact-shutter", "linear"};
};

/// Boxes of one chunk, each of a part of it: a group of neighbouring segments, or all of it. A part's box at
/// key k is boxes[part * keys + k]. With one key it holds the part during the whole span. With two they stand
/// at shutter open and close, and the box between them, linear in the ray's time, holds the part at that
/// time. What is measured has fine boxes as well, for rays that would let the chunk grow.
struct ChunkBounds {
  int keys = 1;
  std::vector<Box3f> boxes;
  FineBoxes fine = {};  ///< hold the whole chunk, at each time of the shutter; or none

  size_t part_count() const { return boxes.size() / static_cast<size_t>(keys); }
  const Box3f& box(size_t part, int key) const {
    return boxes[part * static_cast<size_t>(keys) + static_cast<size_t>(key)];
  }
  /// One part that holds all parts, with the same fine boxes.
  ChunkBounds in_one_part() &&;
  /// Holds all parts at all times; empty for a chunk of nothing.
  Box3f whole() const {
    Box3f all;
    for (const Box3f& box : boxes) all.extendBy(box);
    return all;
  }
};

/// How tight boxes are: sums of surface areas, of the mean over their keys where they move.
struct BoundsArea {
  double chunks = 0;  ///< of the box around all parts of each chunk
  double parts = 0;   ///< of each part's own

  BoundsArea& operator+=(const BoundsArea& other) {
    chunks += other.chunks;
    parts += other.parts;
    return *this;
  }
};
BoundsArea area_of(const ChunkBounds& chunk);

}  // namespace pelage
