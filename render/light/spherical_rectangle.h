// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

/// A rectangle as seen from a point: its axes are x and y, its plane is at z. Samples uniformly in solid
/// angle with an area-preserving map of the square [Urena13]. In double, because the solid angle is a
/// difference of angles.
class SphericalRectangle {
 public:
  /// Centre in the rectangle's own axes, relative to the point.
  SphericalRectangle(double center_x, double center_y, double z, double half_width, double half_height);

  double solid_angle() const { return solid_angle_; }
  /// A point of the rectangle, relative to the viewing point, in the rectangle's axes; u and v in [0, 1).
  V3d sample(double u, double v) const;
  /// Density per solid angle of sample() for a direction that intersects the rectangle at `distance`.
  double pdf(double distance) const;

 private:
  /// Below this, sampling is by area. At 1e-6 sr the solid angle still has nine digits.
  static constexpr double kSmall = 1e-6;

  double x0_, x1_, y0_, y1_, z_;
  double cos_start_, sin_start_;  ///< of the angle k in [Urena13, section 3]: 2 pi minus two interior angles
  double solid_angle_;
  bool small_;
};

}  // namespace pelage
