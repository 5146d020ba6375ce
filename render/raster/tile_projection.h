// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "geom/four_lanes.h"
#include "render/accel/primitive_sink.h"
#include "render/raster/range.h"
#include "render/raster/tile_lines.h"

namespace pelage {

/// Finds which cells of a tile's DepthGrid a shape may cover. A footprint depends only on the shape and the
/// lines of the tile. All points are in the frame of the tile.
class TileProjection {
 public:
  /// `starts`: range of the depths at which lines start.
  TileProjection(const TileLines& lines, const Range& starts);

  /// Four convex hulls of points, one per lane.
  class Hulls {
   public:
    explicit Hulls(const TileProjection& projection) : projection_(projection) {}
    void add(const FourVectors& p);
    /// `radius`: max distance of lines from the hull, at the same depth. `nearer`: added in front of the
    /// hull.
    void find(Four radius, Four nearer, ViewFootprint (&footprints)[4]) const;

   private:
    const TileProjection& projection_;
    Four low_[2] = {kMax, kMax}, high_[2] = {-kMax, -kMax};  // position divided by depth
    Four near_ = kMax, far_ = -kMax;                         // depths
    Four insides_[4] = {-kMax, -kMax, -kMax, -kMax};         // largest distance inside each side
    static constexpr Four kMax = {3e38f, 3e38f, 3e38f, 3e38f};
  };
  void find(const FourViewBoxes& boxes, ViewFootprint (&footprints)[4]) const;
  /// Finds the footprint of the hull of some points.
  ViewFootprint find(std::span<const V3f> points) const;

 private:
  struct Side {
    size_t axis = 0;
    float sign = 1, offset = 0, slope = 0;
  };

  float low_[2], inverse_size_[2];  // of cells
  float last_cell_;
  Range a_[2];
  float inverse_reference_;
  bool has_lens_;
  float first_depth_;  // no line has points before
  Side sides_[4];      // each with all lines on the same side
};

}  // namespace pelage
