// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "geom/four_lanes.h"
#include "render/raster/tile_frame.h"

namespace pelage {

/// Converts points from the grid of a fur tree to the frame of a tile.
class GridToTile {
 public:
  GridToTile() = default;
  /// `anchor`, `step`: the grid, see SegmentGrid.
  GridToTile(const TileFrame& frame, const V3f& anchor, float step) : step_(step) {
    for (int row = 0; row < 3; ++row) {
      const auto r = static_cast<size_t>(row);
      double at = 0;
      for (int axis = 0; axis < 3; ++axis)
        at += static_cast<double>(frame.axes[r][axis]) * (double{anchor[axis]} - frame.origin[axis]);
      rows_[r] = frame.axes[r] * step;
      origin_[row] = static_cast<float>(at);
    }
  }
  /// Converts four points.
  FourVectors operator()(const FourVectors& p) const {
    const auto row = [&](size_t r) {
      return four(origin_[static_cast<int>(r)]) + four(rows_[r].x) * p.x + four(rows_[r].y) * p.y +
             four(rows_[r].z) * p.z;
    };
    return {row(0), row(1), row(2)};
  }
  /// Returns the length of a grid step.
  float step() const { return step_; }

 private:
  std::array<V3f, 3> rows_{};
  V3f origin_{0};
  float step_ = 1;
};

}  // namespace pelage
