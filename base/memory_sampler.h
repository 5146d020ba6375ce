// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "base/memory_sample.h"

namespace pelage {

/// Result of a sampler. Timelines of long runs are thinned as they grow.
struct MemoryHistory {
  MemorySample highest;                ///< the sample with the most anonymous pages
  std::vector<MemorySample> timeline;  ///< in order of time; includes the first and the last sample
};

/// Samples this process's memory periodically, on its own thread. Thread safety: only one thread may call
/// stop(); any thread may charge the ledger.
class MemorySampler {
 public:
  using Clock = std::chrono::steady_clock;
  /// At most this many samples are kept.
  static constexpr size_t kMaxSamples = 4096;

  /// Seconds count from `start`. `ledger` must outlive the sampler.
  MemorySampler(const MemoryLedger& ledger, Clock::time_point start, double interval_s);
  ~MemorySampler();
  MemorySampler(const MemorySampler&) = delete;
  MemorySampler& operator=(const MemorySampler&) = delete;

  /// Takes a last sample and ends the thread. Later calls return the same result.
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
