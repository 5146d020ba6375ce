// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "render/accel/primitive_sink.h"
#include "render/raster/raster_shapes.h"

namespace pelage {

/// A segment in a tile's frame: its four Bezier points and their radii.
struct TileSegment {
  std::array<V3f, 4> p;
  std::array<float, 4> r{};
};

/// Divides a segment into pieces that bend so little that a few steps of Newton's method find which lines
/// meet them.
class FlatPieces {
 public:
  static constexpr size_t kMaxPieces = 8;

  /// Divides a segment that moves from `from` to `to`. Pass the same object twice for a segment at rest.
  /// Radii are enlarged by the max distance between pieces and segment, and by the fraction `wider`. A line
  /// that misses all pieces therefore misses the segment.
  FlatPieces(const TileSegment& from, const TileSegment& to, float wider);

  /// Returns the max distance by which pieces of four segments may extend beyond them, before they are
  /// enlarged by `wider`.
  static Four max_error(const FourSegments& segments);

  const RasterPiece* begin() const { return pieces_.data(); }
  const RasterPiece* end() const { return pieces_.data() + count_; }

 private:
  std::array<RasterPiece, kMaxPieces> pieces_;
  size_t count_ = 0;
};

}  // namespace pelage
