// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "base/memory_sample.h"

namespace pelage {

/// Samples of a MemorySampler. When the timeline is full, every other sample is removed and the interval is
/// doubled.
struct MemoryHistory {
  MemorySample highest;                ///< the sample with the most anonymous pages
  std::vector<MemorySample> timeline;  ///< in order of time; includes the first and the last sample
};

/// Samples the memory of this process periodically, on a thread of its own, which the constructor starts.
/// Thread safety: only one thread may call stop(). Any thread may charge the ledger meanwhile.
class MemorySampler {
 public:
  using Clock = std::chrono::steady_clock;
  /// Max number of samples in the timeline.
  static constexpr size_t kMaxSamples = 4096;

  /// MemorySample::seconds counts from `start`. `interval_s`: seconds between samples at first. `ledger` must
  /// outlive the sampler.
  MemorySampler(const MemoryLedger& ledger, Clock::time_point start, double interval_s);
  ~MemorySampler();
  MemorySampler(const MemorySampler&) = delete;
  MemorySampler& operator=(const MemorySampler&) = delete;

  /// Takes the last sample, ends the thread and returns all samples. Later calls only return the same
  /// samples.
  const MemoryHistory& stop();

 private:
  void run();
  void take();

  const MemoryLedger& ledger_;
  Clock::time_point start_;
  Clock::duration interval_;
  MemoryHistory history_;  // used by the thread until it has been joined

  std::mutex mutex_;  // guards stopping_
  std::condition_variable wake_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace pelage
