// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/process_usage.h"

namespace pelage {

/// Ratio of the times that two implementations take, on a busy machine. The two implementations work in turn,
/// in slices of some milliseconds, so that other load slows down both equally.
class Interleaved {
 public:
  /// `first(slice)` and `second(slice)` do the same work for one slice. Both run once before they are timed.
  template <class First, class Second>
  Interleaved(size_t slices, size_t passes, const First& first, const Second& second) {
    for (size_t slice = 0; slice < slices; ++slice) first(slice), second(slice);
    std::vector<std::vector<double>> ratios(slices), seconds(slices);
    std::vector<double> whole;
    for (size_t pass = 0; pass < passes; ++pass) {
      double sum_first = 0, sum_second = 0;
      for (size_t slice = 0; slice < slices; ++slice) {
        double a = 0, b = 0;
        // The second one finds the rays in the cache and the clock at full speed.
        if ((pass + slice) % 2 == 0) {
          a = timed(first, slice), b = timed(second, slice);
        } else {
          b = timed(second, slice), a = timed(first, slice);
        }
        ratios[slice].push_back(a / b);
        seconds[slice].push_back(b);
        sum_first += a, sum_second += b;
      }
      whole.push_back(sum_first / sum_second);
    }
    double first_s = 0;
    for (size_t slice = 0; slice < slices; ++slice) {
      const double s = quantile(seconds[slice], 0.5);
      first_s += s * quantile(ratios[slice], 0.5);
      second_s_ += s;
    }
    ratio_ = first_s / second_s_;
    low_ = quantile(whole, 0.25);
    high_ = quantile(whole, 0.75);
  }

  /// Time of the first divided by the time of the second: for each slice the median over all passes, weighted
  /// by the time of the slice.
  double ratio() const { return ratio_; }
  /// Quartiles of the ratios of whole passes.
  double low() const { return low_; }
  double high() const { return high_; }
  /// Seconds that the second takes for all slices.
  double second_s() const { return second_s_; }

  void show(benchmark::State& state, const std::string& name) const {
    state.counters[name] = ratio_;
    state.counters[name + ", quartiles 1"] = low_;
    state.counters[name + ", quartiles 3"] = high_;
  }

 private:
  template <class Work>
  static double timed(const Work& work, size_t slice) {
    const double start = cpu_seconds();
    work(slice);
    return cpu_seconds() - start;
  }
  static double quantile(std::vector<double> of, double part) {
    std::sort(of.begin(), of.end());
    return of[static_cast<size_t>(part * static_cast<double>(of.size() - 1) + 0.5)];
  }

  double ratio_ = 0, low_ = 0, high_ = 0, second_s_ = 0;
};

}  // namespace pelage
