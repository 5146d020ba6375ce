// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <vector>

namespace pelage {

/// Limits how many threads may grow units of a Residency (chunks of fur or skin) at the same time. When most
/// of the units being grown were evicted only recently, the threads are evicting each other's units: the
/// working sets of all threads do not fit together. The limit is then lowered, down to one thread, and the
/// other threads wait. The limit is raised when threads no longer evict each other's units.
///
/// While the limit is below the number of threads, a thread needs a turn to grow units. It keeps its turn as
/// long as it grows units. A thread that has grown nothing for kIdleTimeout loses its turn, so that other
/// threads do not wait for a thread that needs no more units or has ended. Not thread safe.
class GrowthThrottle {
 public:
  using Clock = std::chrono::steady_clock;
  /// A turn that has not been used for this long is free.
  static constexpr std::chrono::milliseconds kIdleTimeout{500};

  explicit GrowthThrottle(int threads);

  /// Whether a thread may grow a unit now. If so, the thread has a turn.
  bool may_grow(int thread, Clock::time_point now);
  /// Records that a thread has grown a unit; `again_soon`: the unit had been evicted recently.
  void grown(int thread, bool again_soon, Clock::time_point now);
  int concurrency() const { return concurrency_; }

 private:
  struct Turn {
    int thread;
    Clock::time_point used;
  };
  void set_concurrency(int count);

  const int threads_;
  int concurrency_;
  int good_ = 0, needed_ = 1;   // windows with few repeated growths; how many of them raise the limit
  int window_ = 0, again_ = 0;  // growths since the last evaluation; those of recently evicted units
  std::vector<Turn> turns_;     // empty while all threads may grow
};

}  // namespace pelage
