// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "base/vector.h"
#include "geom/four_lanes.h"

namespace pelage {

/// The grid that the points of a tree's segments are given in: scene = anchor + step * grid.
struct SegmentGrid {
  V3f anchor{0};
  float step = 1;
  int motion_keys = 1;
};

/// Four segments side by side at one motion key: Bezier points in grid units, radii.
struct FourSegments {
  FourVectors p[4];
  Four r[4];
};

/// Receives the primitives of a chunk that may lie inside a beam; see ChunkGeometry::visit_primitives().
class PrimitiveSink {
 public:
  virtual ~PrimitiveSink() = default;
  /// Depth along the beam beyond which no primitive is needed; may decrease between calls.
  virtual float far() const = 0;
  /// The segments that follow are on this grid.
  virtual void begin_segments(const SegmentGrid& grid) = 0;
  static constexpr uint32_t kNone = ~0u;
  /// Segments of a fur tree; `keys`: one per motion key; kNone: the number of an empty lane. A segment may be
  /// passed several times.
  virtual void segments(const uint32_t (&numbers)[4], std::span<const FourSegments> keys) = 0;
  /// A triangle; `corners`: three per motion key.
  virtual void triangle(uint32_t number, std::span<const V3f> corners) = 0;
};

}  // namespace pelage
