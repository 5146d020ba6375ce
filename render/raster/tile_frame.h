// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "base/vector.h"
#include "geom/four_lanes.h"

namespace pelage {

/// An orthonormal frame in world space. Its z axis is the view direction through the middle of a tile.
struct TileFrame {
  V3f origin{0};
  std::array<V3f, 3> axes{V3f(1, 0, 0), V3f(0, 1, 0), V3f(0, 0, 1)};

  /// Returns a frame with this origin and z axis. `direction`: unit.
  static TileFrame along(const V3f& origin, const V3f& direction) {
    const V3f side = direction.cross(std::abs(direction.x) < 0.6f ? V3f(1, 0, 0) : V3f(0, 1, 0)).normalized();
    return {origin, {side, direction.cross(side).normalized(), direction}};
  }
  /// Converts a vector from world space.
  V3f rotated(const V3f& v) const { return {axes[0].dot(v), axes[1].dot(v), axes[2].dot(v)}; }
  /// Converts a point from world space.
  V3f local(const V3f& world) const { return rotated(world - origin); }
};

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
