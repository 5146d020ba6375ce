// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "render/accel/beam.h"
#include "render/raster/tile_frame.h"
#include "render/raster/tile_lines.h"

namespace pelage {

/// The region that contains all lines of a tile between two depths, bounded by planes on four sides.
class TileBeam {
 public:
  /// The region contains the lines at depths `first` <= `last`. `near`: min depth at which lines start.
  TileBeam(const TileFrame& frame, const TileLines& lines, float near, float first, float last);

  const Beam& beam() const { return beam_; }

 private:
  struct Side {
    int axis = 0;
    float sign = 1;  ///< 1 if the inside has larger coordinates than the plane, else -1
    float offset = 0, slope = 0;
  };
  std::array<Side, 4> sides_;
  Beam beam_;
};

}  // namespace pelage
