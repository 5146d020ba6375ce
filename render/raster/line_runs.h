// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "render/raster/raster_shapes.h"
#include "render/raster/tile_lines.h"

namespace pelage {

/// Finds the lines of a tile that a shape may meet, as runs of consecutive lines.
class LineRuns {
 public:
  /// Keeps a reference to `lines`. `near`: max depth at which a line starts.
  LineRuns(const TileLines& lines, float near) : lines_(lines), near_(near) {}

  /// Finds the runs for a shape, which replace those of the last shape. `keys`: see draw().
  void find(const RasterPiece& piece, const KeySpan& keys);
  void find(const RasterTriangle& triangle, const KeySpan& keys);
  std::span<const TileLines::Run> runs() const { return {runs_.data(), count_}; }

 private:
  struct Point {
    V2f at{0};
    float width = 0;  ///< max distance of lines that may pass through the point
  };
  struct Box {
    Range x, y;
    void add(const Point& p) {
      x.extend(Range{p.at.x - p.width, p.at.x + p.width});
      y.extend(Range{p.at.y - p.width, p.at.y + p.width});
    }
  };
  bool all_if_near(float min_depth, float reach);
  Point project(const TileLines::Group& group, const V3f& p, float reach, float min_depth) const;
  void add_capsule(const TileLines::Group& group, const Point& from, const Point& to);
  void add_box(const TileLines::Group& group, const Box& box);
  void add(const TileLines::Run& run);

  const TileLines& lines_;
  float near_;
  std::array<TileLines::Run, 4 * TileLines::kMaxRows> runs_;
  size_t count_ = 0;
};

/// Returns the range of KeySpan's f over the lines of a group; empty if the times of all lines are outside
/// the span.
Range key_fractions(const TileLines::Group& group, const KeySpan& keys);

}  // namespace pelage
