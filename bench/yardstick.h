// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include <benchmark/benchmark.h>

#include "base/process_usage.h"

namespace pelage {

/// Processor seconds that one call of `work(i)` takes, the best of several runs in this process.
template <class Work>
double seconds_per_call(Work&& work, int calls = 200000, int runs = 15) {
  double best = 1e30;
  for (int run = 0; run < runs; ++run) {
    const double start = cpu_seconds();
    for (int i = 0; i < calls; ++i) benchmark::DoNotOptimize(work(i));
    best = std::min(best, (cpu_seconds() - start) / calls);
  }
  return best;
}

/// Adds a column to a benchmark: the time of one iteration divided by the yardstick's time. Construct it just
/// before the benchmark's loop.
class RatioTo {
 public:
  RatioTo(benchmark::State& state, const char* column, double yardstick_seconds)
      : state_(state), column_(column), yardstick_(yardstick_seconds), start_(cpu_seconds()) {}
  ~RatioTo() {
    state_.counters[column_] =
        (cpu_seconds() - start_) / (static_cast<double>(state_.iterations()) * yardstick_);
  }
  RatioTo(const RatioTo&) = delete;
  RatioTo& operator=(const RatioTo&) = delete;

 private:
  benchmark::State& state_;
  const char* column_;
  double yardstick_;
  double start_;
};

}  // namespace pelage
