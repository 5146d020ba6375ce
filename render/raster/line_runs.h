// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "render/raster/raster_shapes.h"
#include "render/raster/tile_lines.h"

namespace pelage {

/// The lines of a tile that a shape may meet, as runs.
class LineRuns {
 public:
  /// `lines` outlives it. No line starts beyond depth `near`.
  LineRuns(const TileLines& lines, float near) : lines_(lines), near_(near) {}

  /// Collects the runs for a piece. `keys` as for draw().
  void find(const RasterPiece& piece, const KeySpan& keys);
  void find(const RasterTriangle& triangle, const KeySpan& keys);
  std::span<const TileLines::Run> runs() const { return {runs_.data(), count_}; }

 private:
  struct Point {
    V2f at{0};
    float width = 0;  ///< how far lines that pass beside it may be
  };
  struct Box {
    Range x, y;
    void add(const Point& p) {
      x.extend(Range{p.at.x - p.width, p.at.x + p.width});
      y.extend(Range{p.at.y - p.width, p.at.y + p.width});
    }
  };
  bool all_if_near(float least_depth, float reach);
  Point project(const TileLines::Group& group, const V3f& p, float reach, float least_depth) const;
  void add_capsule(const TileLines::Group& group, const Point& from, const Point& to);
  void add_box(const TileLines::Group& group, const Box& box);
  void add(const TileLines::Run& run);

  const TileLines& lines_;
  float near_;
  std::array<TileLines::Run, 4 * TileLines::kMaxRows> runs_;
  size_t count_ = 0;
};

/// The fractions of the way between two motion keys that the lines of a group take; empty where they are at
/// other times.
Range key_fractions(const TileLines::Group& group, const KeySpan& keys);

}  // namespace pelage
