// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "geom/four_lanes.h"
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
  /// For each side, computes how far each of four points is inside (negative: outside), and replaces
  /// `largest` if the distance is larger.
  void add_insides(const FourVectors& p, Four (&largest)[4]) const {
    for (size_t i = 0; i < 4; ++i) {
      const Side& side = sides_[i];
      const Four along = side.axis == 0 ? p.x : p.y;
      largest[i] = larger(largest[i], four(side.sign) * (along - four(side.offset) - four(side.slope) * p.z));
    }
  }
  /// Returns whether the spheres with this radius around all points are outside the same side. Points are in
  /// the frame of the tile.
  template <class Points>
  bool misses(const Points& points, float radius) const {
    for (const Side& side : sides_) {
      bool outside = true;
      for (const V3f& p : points) outside = outside && side.sign * (p[side.axis] - side.at(p.z)) + radius < 0;
      if (outside) return true;
    }
    return false;
  }

 private:
  struct Side {
    int axis = 0;
    float sign = 1;  ///< 1 if the inside has larger coordinates than the plane, else -1
    float offset = 0, slope = 0;
    float at(float z) const { return offset + slope * z; }
  };
  std::array<Side, 4> sides_;
  Beam beam_;
};

}  // namespace pelage
