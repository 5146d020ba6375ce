// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "base/vector.h"
#include "geom/four_lanes.h"

namespace pelage {

/// The grid of a tree, in whose units the points of segments are given: scene = anchor + step * grid.
struct SegmentGrid {
  V3f anchor{0};
  float step = 1;
  int motion_keys = 1;
};

/// Four segments at one motion key, one per lane: Bezier points and radii, in grid units.
struct FourSegments {
  FourVectors p[4];
  Four r[4];
};

/// Receives the primitives of a chunk that may lie inside a beam; see ChunkGeometry::visit_primitives().
class PrimitiveSink {
 public:
  virtual ~PrimitiveSink() = default;
  /// Returns the depth along the beam beyond which no primitive is needed. It may decrease between calls.
  virtual float far() const = 0;
  /// Announces the grid of the segments that follow.
  virtual void begin_segments(const SegmentGrid& grid) = 0;
  static constexpr uint32_t kNone = ~0u;
  /// Receives four segments of a fur tree. `numbers`: segment numbers; kNone for an empty lane. `keys`: one
  /// element per motion key. A segment may be passed several times.
  virtual void segments(const uint32_t (&numbers)[4], std::span<const FourSegments> keys) = 0;
  /// Receives a triangle. `corners`: three per motion key.
  virtual void triangle(uint32_t number, std::span<const V3f> corners) = 0;
};

}  // namespace pelage
