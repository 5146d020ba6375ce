// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

/// A rectangle as seen from a viewing point. In its own axes, relative to the viewing point, the sides of the
/// rectangle are along x and y, and its plane is at z. Samples uniformly in solid angle, with an
/// area-preserving map of the unit square [Urena13]. Computes in double, because the solid angle is a
/// difference of angles.
class SphericalRectangle {
 public:
  /// (center_x, center_y, z): centre of the rectangle in its own axes, relative to the viewing point.
  SphericalRectangle(double center_x, double center_y, double z, double half_width, double half_height);

  /// Returns the solid angle in steradians.
  double solid_angle() const { return solid_angle_; }
  /// Samples a point of the rectangle. Returns it in the rectangle's axes, relative to the viewing point.
  /// `u`, `v`: random numbers in [0, 1).
  V3d sample(double u, double v) const;
  /// Returns the density of sample(), per solid angle, for a direction that intersects the rectangle at
  /// `distance`.
  double pdf(double distance) const;

 private:
  /// Solid angle in steradians below which sampling is uniform in area instead. At this value, the solid
  /// angle still has nine correct digits.
  static constexpr double kSmall = 1e-6;

  double x0_, x1_, y0_, y1_, z_;
  double cos_start_, sin_start_;  ///< of angle k in [Urena13, section 3]: 2 pi minus two interior angles
  double solid_angle_;
  bool small_;  ///< whether sampling is uniform in area
};

}  // namespace pelage
