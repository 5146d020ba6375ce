// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace pelage {

/// Running mean and variance [Welford62], in double because sums of squares would cancel.
struct PixelMoments {
  double mean = 0;
  double squares = 0;  ///< sum of squared deviations from the mean
  uint32_t count = 0;

  void add(double x) {
    ++count;
    const double from_old = x - mean;
    mean += from_old / count;
    squares += from_old * (x - mean);
  }
  /// Variance of one number; 0 for fewer than two.
  double variance() const { return count > 1 ? squares / (count - 1) : 0; }
  /// Standard error of the mean for independent numbers; stratified ones have a smaller error.
  double error() const { return count > 1 ? std::sqrt(variance() / count) : 0; }
};

}  // namespace pelage
