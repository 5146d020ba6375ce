// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "base/memory_sample.h"

namespace pelage {

/// What a sampler saw. Timelines of long runs are thinned out as they grow, so that they stay small.
struct MemoryHistory {
  MemorySample highest;                ///< when the anonymous pages were at their highest
  std::vector<MemorySample> timeline;  ///< in order of time; the first and the last moment included
};

/// Looks at this process's memory again and again, from a thread of its own. Thread safety: stop() by one
/// thread; the ledger may be charged by any.
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

  /// Takes a last sample and ends the thread. Later calls return the same.
  const MemoryHistory& stop();

 private:
  void run();
  void take();

  const MemoryLedger& ledger_;
  Clock::time_point start_;
  Clock::duration interval_;
  MemoryHistory history_;  // the thread's, until it has been joined

  std::mutex mutex_;  // guards stopping_
  std::condition_variable wake_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace pelage
