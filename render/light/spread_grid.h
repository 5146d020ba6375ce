// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pelage {

/// A grid of thin black walls in front of a panel, as on softboxes: the farther a direction is from the
/// normal, the more of its light the walls take. As the spread of Cycles' area lights.
class SpreadGrid {
 public:
  /// No grid.
  SpreadGrid() = default;
  /// `degrees`: the whole angle beyond which no light passes, from 1; no grid from 180 on.
  explicit SpreadGrid(float degrees);

  /// Returns the fraction of light that passes at an angle to the normal, given by its cosine.
  float factor(float cosine) const;
  /// Returns the tangent of the angle to the normal beyond which no light passes; infinite without a grid.
  float max_slope() const;
  /// Returns the fraction of the power of a panel that passes.
  double passed_fraction() const;

 private:
  double half_angle_ = 0;
  float slope_ = 0;  // 1 / tan of the half angle
};

}  // namespace pelage
