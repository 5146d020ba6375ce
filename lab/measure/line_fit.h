// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>

namespace pelage {

/// A straight line through points (x, y) by least squares, and how far what it says can be trusted.
struct LineFit {
  double at_zero = 0, slope = 0;
  double residual = 0;  ///< standard deviation of the points about the line (of n - 2); 0 for two points
  double mean = 0;      ///< of x
  double spread = 0;    ///< sum of (x - mean)^2
  double count = 0;

  double at(double x) const { return at_zero + slope * x; }
  /// Standard error of at(x), from the residual alone: it knows nothing of a line that bends further on.
  double error_at(double x) const;
};

/// Not-a-numbers for fewer than two different x, or where a y is not a number.
LineFit fit_line(std::span<const std::pair<double, double>> points);

}  // namespace pelage
