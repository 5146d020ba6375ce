// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "render/raster/raster_shapes.h"
#include "render/raster/tile_lines.h"

namespace pelage {

/// Decides at which semi-transparent shapes a line stops.
class RasterFilter {
 public:
  virtual ~RasterFilter() = default;
  /// `u`: of the segment.
  virtual bool stops(uint32_t random, float u) const = 0;
};

/// What the kernels draw to, and who is drawn.
struct RasterTarget {
  TileLines::Arrays lines;
  bool has_lens = false;
  float near = 0;  ///< nothing is met at depths up to this
  uint32_t chunk = 0, primitive = 0;
  const RasterFilter* filter = nullptr;  ///< null: all lines stop
};

/// Makes the piece the winner of those lines of the runs that meet it before all others. Of two primitives at
/// the same depth none wins: TileWinner::kTraced. Returns whether anything changed. `keys`: for shapes that
/// move; lines of other times are left alone.
bool draw(const RasterTarget& target, std::span<const TileLines::Run> runs, const RasterPiece& piece,
          const KeySpan& keys);
bool draw(const RasterTarget& target, std::span<const TileLines::Run> runs, const RasterTriangle& triangle,
          const KeySpan& keys);

}  // namespace pelage
