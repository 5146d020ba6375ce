// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>

namespace pelage {

/// A least-squares line through points (x, y), with the data to compute its standard error.
struct LineFit {
  double at_zero = 0, slope = 0;  ///< value at x = 0, and slope
  /// Standard deviation of the points from the line, with n - 2 degrees of freedom; 0 for two points.
  double residual = 0;
  double mean = 0;    ///< mean of the points' x
  double spread = 0;  ///< sum of (x - mean)^2 over the points
  double count = 0;   ///< number of points

  /// Value of the line at x.
  double at(double x) const { return at_zero + slope * x; }
  /// Standard error of at(x). Follows from the residual alone. Does not account for data that deviate from a
  /// line beyond the points.
  double error_at(double x) const;
};

/// Returns the line. All members except `count` are NaN if the points have fewer than two different x. at()
/// is NaN if a y is NaN.
LineFit fit_line(std::span<const std::pair<double, double>> points);

}  // namespace pelage
