// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "geom/four_lanes.h"
#include "procedurals/bounds/segment_cell_bounds.h"
#include "render/accel/primitive_sink.h"
#include "render/raster/tile_frame.h"

namespace pelage {

/// Converts the cell bounds of a chunk to boxes in the frame of a tile.
class SegmentCellView {
 public:
  /// `margin`: by which boxes are enlarged on every side, in scene units.
  SegmentCellView(const TileFrame& frame, const SegmentCellBounds::Grid& grid, float margin) {
    const float far = (grid.corner - frame.origin).length() + 255 * grid.step.length() +
                      grid.motion.length() + frame.origin.length();
    for (size_t row = 0; row < 3; ++row) {
      double corner = 0;
      float outward = kRounding * far;
      low_[row] = high_[row] = 0;
      for (size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<int>(axis);
        const float component = frame.axes[row][a];
        corner += static_cast<double>(component) * (static_cast<double>(grid.corner[a]) - frame.origin[a]);
        outward += std::abs(component) * margin;
        low_[row] += std::min(component * grid.motion[a], 0.0f);
        high_[row] += std::max(component * grid.motion[a], 0.0f);
        steps_[row][axis] = component * grid.step[a];
      }
      low_[row] += static_cast<float>(corner) - outward;
      high_[row] += static_cast<float>(corner) + outward;
    }
  }
  /// Whether all boxes are finite. Without this, they have no meaning.
  bool is_finite() const {
    float sum = 0;
    for (size_t row = 0; row < 3; ++row) {
      sum += std::abs(low_[row]) + std::abs(high_[row]);
      for (const float step : steps_[row]) sum += 255 * std::abs(step);
    }
    return std::isfinite(sum);
  }
  /// Returns boxes that contain the four boxes of a group, enlarged by the margin, over the whole shutter.
  /// Lanes of missing boxes have no meaning.
  FourViewBoxes operator()(const SegmentCellBounds::Group& group) const {
    FourVectors low{four(low_[0]), four(low_[1]), four(low_[2])};
    FourVectors high{four(high_[0]), four(high_[1]), four(high_[2])};
    Four* const lows[3] = {&low.x, &low.y, &low.z};
    Four* const highs[3] = {&high.x, &high.y, &high.z};
    for (size_t axis = 0; axis < 3; ++axis) {
      const Four from = floats(group[axis][0]), to = floats(group[axis][1]);
      for (size_t row = 0; row < 3; ++row) {
        const Four a = four(steps_[row][axis]) * from, b = four(steps_[row][axis]) * to;
        *lows[row] += smaller(a, b);
        *highs[row] += larger(a, b);
      }
    }
    return {low, high};
  }
  /// Whether a box of a group exists.
  static bool exists(const SegmentCellBounds::Group& group, size_t lane) {
    return group[0][0][lane] <= group[0][1][lane];
  }

 private:
  static constexpr float kRounding = 1e-6f;

  static Four floats(const std::array<uint8_t, 4>& b) {
    return Four{static_cast<float>(b[0]), static_cast<float>(b[1]), static_cast<float>(b[2]),
                static_cast<float>(b[3])};
  }

  std::array<float, 3> low_{}, high_{};          // of step 0, by axis of the tile
  std::array<std::array<float, 3>, 3> steps_{};  // by axis of the tile and axis of the boxes
};

}  // namespace pelage
