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

/// Four boxes in the frame of a beam, one per lane; see Beam::across and Beam::depth.
struct FourViewBoxes {
  FourVectors low, high;
};

/// The part of a picture that a box may cover: cells first .. last of a grid, by axis. Empty if the first
/// cell is after the last.
struct ViewFootprint {
  float depth = 0;  ///< min depth of the box
  uint8_t first[2] = {1, 1}, last[2] = {0, 0};

  bool is_empty() const { return first[0] > last[0] || first[1] > last[1]; }
};

/// Receives the primitives of a chunk that may lie inside a beam; see ChunkGeometry::visit_primitives().
class PrimitiveSink {
 public:
  virtual ~PrimitiveSink() = default;
  /// Returns the depth along the beam beyond which no primitive is needed. It may decrease between calls.
  virtual float far() const = 0;
  /// Finds the part of the picture that each of four boxes may cover.
  virtual void find_footprints(const FourViewBoxes& boxes, ViewFootprint (&footprints)[4]) const = 0;
  /// Whether the primitives that were passed before hide everything with this footprint.
  virtual bool hides(const ViewFootprint& footprint) const = 0;
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
