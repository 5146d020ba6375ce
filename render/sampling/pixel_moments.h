// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace pelage {

/// Running mean and variance of independent numbers, each of which is the mean of one or more samples. The
/// variance of a number is that of a sample, divided by the count of its samples. Welford's update
/// [Welford62] with weights [West79], in double, avoids the cancellation that sums of squares would suffer.
struct PixelMoments {
  double mean = 0;
  double squares = 0;    ///< sum of squared deviations from the mean, weighted by samples
  uint32_t count = 0;    ///< of numbers
  uint32_t samples = 0;  ///< in all numbers

  void add(double x, uint32_t of = 1) {
    ++count;
    samples += of;
    const double from_old = x - mean;
    mean += of * from_old / samples;
    squares += of * from_old * (x - mean);
  }
  /// Returns the unbiased estimate of the variance of a sample; 0 if there are fewer than two numbers.
  double variance() const { return count > 1 ? squares / (count - 1) : 0; }
  /// Returns the standard error of the mean; 0 if there are fewer than two numbers. The error of stratified
  /// samples is smaller.
  double error() const { return count > 1 ? std::sqrt(variance() / samples) : 0; }
};

}  // namespace pelage
