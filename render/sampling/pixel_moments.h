// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace pelage {

/// Running mean and variance of a sequence of numbers. Welford's update [Welford62] in double avoids the
/// cancellation that sums of squares would suffer.
struct PixelMoments {
  double mean = 0;
  double squares = 0;  ///< sum of squared deviations from the mean
  uint32_t count = 0;
  uint32_t unused = 0;  ///< makes each byte of the struct defined

  void add(double x) {
    ++count;
    const double from_old = x - mean;
    mean += from_old / count;
    squares += from_old * (x - mean);
  }
  /// Returns the unbiased estimate of the variance of the numbers; 0 if there are fewer than two.
  double variance() const { return count > 1 ? squares / (count - 1) : 0; }
  /// Returns the standard error of the mean if the numbers are independent; 0 if there are fewer than two.
  /// The error of stratified numbers is smaller.
  double error() const { return count > 1 ? std::sqrt(variance() / count) : 0; }
};

}  // namespace pelage
