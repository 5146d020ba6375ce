// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>

namespace pelage {

/// A least-squares line through points (x, y), with the data for its standard error.
struct LineFit {
  double at_zero = 0, slope = 0;
  double residual = 0;  ///< standard deviation of the points about the line (of n - 2); 0 for two points
  double mean = 0;      ///< mean of x
  double spread = 0;    ///< sum of (x - mean)^2
  double count = 0;

  double at(double x) const { return at_zero + slope * x; }
  /// Standard error of at(x), from the residual alone: does not account for a curve that bends beyond the
  /// points.
  double error_at(double x) const;
};

/// NaNs for fewer than two different x, or when a y is NaN.
LineFit fit_line(std::span<const std::pair<double, double>> points);

}  // namespace pelage
