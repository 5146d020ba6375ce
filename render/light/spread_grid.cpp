// SPDX-License-Identifier: Apache-2.0
#include "render/light/spread_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pelage {

SpreadGrid::SpreadGrid(float degrees) {
  if (degrees >= 180) return;
  half_angle_ = 0.5 * double{degrees} * std::numbers::pi / 180;
  slope_ = static_cast<float>(1 / std::tan(half_angle_));
}

float SpreadGrid::factor(float cosine) const {
  if (!(slope_ > 0)) return 1;
  const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
  return cosine > 0 ? std::max(0.0f, 1 - slope_ * sine / cosine) : 0.0f;
}

float SpreadGrid::max_slope() const {
  return slope_ > 0 ? 1 / slope_ : std::numeric_limits<float>::infinity();
}

/// The integral of cos * sin * factor up to the half angle, relative to the integral of cos * sin up to a
/// right angle.
double SpreadGrid::passed_fraction() const {
  return slope_ > 0 ? 1 - half_angle_ / std::tan(half_angle_) : 1;
}

}  // namespace pelage
