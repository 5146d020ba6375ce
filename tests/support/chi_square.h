// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace pelage {

/// Upper tail of the chi-square distribution: the regularised incomplete gamma function Q(dof / 2, statistic
/// / 2), by its series or its continued fraction [Press92, section 6.2].
inline double chi_square_tail(double statistic, double dof) {
  const double a = 0.5 * dof, x = 0.5 * statistic;
  if (!(x > 0)) return 1;
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 100000 && term > sum * 1e-16; ++n) sum += term *= x / (a + n);
    return 1 - front * sum;
  }
  constexpr double kTiny = 1e-300;
  double b = x + 1 - a, c = 1 / kTiny, d = 1 / b, h = d;
  for (int n = 1; n < 100000; ++n) {
    const double an = -n * (n - a);
    b += 2;
    d = an * d + b;
    d = 1 / (std::abs(d) < kTiny ? kTiny : d);
    c = b + an / c;
    if (std::abs(c) < kTiny) c = kTiny;
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return front * h;
}

/// Two-sided tail of the normal distribution.
inline double normal_tail(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

/// Significance level for each of `tests` independent tests, such that all pass together with probability 1 -
/// `level` when the hypothesis is true [Sidak67].
inline double sidak_level(double level, double tests) { return -std::expm1(std::log1p(-level) / tests); }

struct ChiSquare {
  double statistic = 0;
  int dof = 0;
  double p = 1;
  double impossible = 0;  ///< counts in cells whose expectation is zero
};

/// Compares counts with their expectations. Cells with an expectation below 5 are merged, smallest first.
inline ChiSquare chi_square(const std::vector<double>& observed, const std::vector<double>& expected) {
  std::vector<size_t> order(expected.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });
  ChiSquare result;
  double pooled_expected = 0, pooled_observed = 0;
  int cells = 0;
  for (size_t i : order) {
    if (expected[i] <= 0) {
      result.impossible += observed[i];
      continue;
    }
    pooled_expected += expected[i];
    pooled_observed += observed[i];
    if (pooled_expected < 5) continue;
    const double off = pooled_observed - pooled_expected;
    result.statistic += off * off / pooled_expected;
    pooled_expected = pooled_observed = 0;
    ++cells;
  }
  result.dof = cells - 1;
  if (result.dof > 0) result.p = chi_square_tail(result.statistic, result.dof);
  return result;
}

/// Mean and variance of a stream of numbers [Welford62].
class RunningMean {
 public:
  void add(double x) {
    const double off = x - mean_;
    mean_ += off / ++count_;
    squares_ += off * (x - mean_);
  }
  double mean() const { return mean_; }
  double variance() const { return count_ > 1 ? squares_ / (count_ - 1) : 0; }
  /// Standard error of the mean.
  double standard_error() const { return std::sqrt(variance() / count_); }

 private:
  double count_ = 0, mean_ = 0, squares_ = 0;
};

}  // namespace pelage
