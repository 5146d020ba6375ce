// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/accel/chunk_geometry.h"
#include "render/raster/flat_pieces.h"
#include "render/raster/grid_to_tile.h"
#include "render/raster/line_runs.h"
#include "render/raster/raster_kernels.h"
#include "render/raster/tile_beam.h"
#include "render/raster/tile_frame.h"
#include "render/raster/tile_lines.h"

namespace pelage {

/// Draws the primitives of chunks to the lines of a tile.
class TileDrawing final : public PrimitiveSink {
 public:
  /// `starts`: range of the depths at which lines start. Keeps a reference to `lines`.
  TileDrawing(const TileFrame& frame, const Range& starts, TileLines& lines);

  /// Draws a chunk. `depths`: range that contains the chunk. Returns false if a primitive cannot be drawn.
  /// The caller must then trace the rays of all samples of the tile.
  bool draw(const ChunkGeometry& geometry, uint32_t chunk, const Range& depths);
  /// Returns the region that contains the lines in a range of depths.
  TileBeam beam(const Range& depths) const {
    return {frame_, lines_, starts_.low, std::max(depths.low, starts_.low), depths.high};
  }
  /// Returns the depth beyond which nothing can be seen.
  float far() const override { return far_; }
  /// Updates far() if anything was drawn since the last call.
  void update_far();

  void begin_segments(const SegmentGrid& grid) override;
  void segments(const uint32_t (&numbers)[4], std::span<const FourSegments> keys) override;
  void triangle(uint32_t number, std::span<const V3f> corners) override;

 private:
  class Opacity;

  void draw_segment(uint32_t number, size_t lane);
  bool is_hidden(const Range& depths) const { return depths.low > far_ || depths.high < starts_.low; }
  bool is_possible(const RasterPiece& piece) const;
  template <class Shape>
  void draw_shape(const Shape& shape, const KeySpan& keys);
  static KeySpan key_span(size_t key, size_t keys);

  const TileFrame frame_;
  const Range starts_;
  TileLines& lines_;
  LineRuns runs_;
  RasterTarget target_;
  const ChunkGeometry* geometry_ = nullptr;
  const TileBeam* beam_ = nullptr;
  GridToTile grid_;
  std::vector<FourSegments> segments_;  // in the tile's frame, by motion key
  std::vector<V3f> corners_;
  float wider_ = 0;
  float far_;
  int changes_ = 0;  // since far_ was found
  bool possible_ = true;
};

}  // namespace pelage
