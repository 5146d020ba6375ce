// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "render/raster/raster_shapes.h"
#include "render/raster/tile_lines.h"

namespace pelage {

/// Decides whether a line stops at a semi-transparent shape.
class RasterFilter {
 public:
  virtual ~RasterFilter() = default;
  /// `random`: TileLine::random. `u`: parameter in the segment.
  virtual bool stops(uint32_t random, float u) const = 0;
};

/// The lines that kernels draw to, and the primitive that they draw.
struct RasterTarget {
  TileLines::Arrays lines;
  bool has_lens = false;
  float near = 0;     ///< lines ignore primitives up to this depth
  float certain = 0;  ///< where a line meets a primitive up to this depth, its winner becomes kTraced
  uint32_t chunk = 0, primitive = 0;
  const RasterFilter* filter = nullptr;  ///< null: the primitive is opaque
};

/// Draws a shape to the lines of some runs. The shape becomes the winner of each line that meets it before
/// all other shapes. If two primitives are at the same depth, the winner becomes TileWinner::kTraced. `keys`:
/// the part of the shutter for which a moving shape is given; lines of other times are not changed. Returns
/// whether any line was changed.
bool draw(const RasterTarget& target, std::span<const TileLines::Run> runs, const RasterPiece& piece,
          const KeySpan& keys);
bool draw(const RasterTarget& target, std::span<const TileLines::Run> runs, const RasterTriangle& triangle,
          const KeySpan& keys);

}  // namespace pelage
