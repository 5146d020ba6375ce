// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/accel/chunk_geometry.h"
#include "render/raster/flat_pieces.h"
#include "render/raster/line_runs.h"
#include "render/raster/raster_kernels.h"
#include "render/raster/tile_frame.h"
#include "render/raster/tile_lines.h"
#include "render/raster/tile_projection.h"

namespace pelage {

/// Draws the primitives of chunks to the lines of a tile.
class TileDrawing final : public PrimitiveSink {
 public:
  /// `starts`: range of the depths at which lines start. Keeps a reference to `lines`.
  TileDrawing(const TileFrame& frame, const Range& starts, TileLines& lines);

  /// Draws a chunk. `depths`: range that contains the chunk. Returns false if the chunk does not support
  /// this. Lines that may meet a primitive that cannot be drawn become lines to be traced.
  bool draw(const ChunkGeometry& geometry, uint32_t chunk, const Range& depths);
  /// Returns the region that contains the lines in a range of depths.
  TileBeam beam(const Range& depths) const {
    return {frame_, lines_, starts_.low, std::max(depths.low, starts_.low), depths.high};
  }
  /// Updates far() and hides() if anything was drawn since the last call.
  void update();
  /// Whether a box may have points that the lines see.
  bool may_see(const Box3f& box) const;
  /// The same for four boxes in the frame of the tile.
  std::array<bool, 4> may_see(const FourViewBoxes& boxes) const;
  const TileFrame& frame() const { return frame_; }
  float far() const override { return lines_.grid().far(); }
  void find_footprints(const FourViewBoxes& boxes, ViewFootprint (&footprints)[4]) const override {
    projection_.find(boxes, footprints);
  }
  bool hides(const ViewFootprint& footprint) const override { return lines_.grid().hides(footprint); }

  void begin_segments(const SegmentGrid& grid) override;
  void segments(const uint32_t (&numbers)[4], std::span<const FourSegments> keys) override;
  void triangle(uint32_t number, std::span<const V3f> corners) override;

 private:
  class Opacity;

  bool was_passed(uint32_t number);
  void draw_segment(uint32_t number, size_t lane, const ViewFootprint& footprint);
  bool is_possible(const RasterPiece& piece) const;
  template <class Shape>
  void draw_shape(const Shape& shape, const KeySpan& keys);
  static KeySpan key_span(size_t key, size_t keys);

  const TileFrame frame_;
  const Range starts_;
  TileLines& lines_;
  const TileProjection projection_;
  LineRuns runs_;
  RasterTarget target_;
  const ChunkGeometry* geometry_ = nullptr;
  GridToTile grid_;
  std::vector<FourSegments> segments_;  // in the tile's frame, by motion key
  std::vector<V3f> corners_;
  std::vector<uint64_t> passed_;  // a bit per segment of the chunk
  float wider_ = 0;
  int changes_ = 0;  // since the grid was updated
  const int changes_per_update_;
};

}  // namespace pelage
