// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <vector>

namespace pelage {

/// Limits the number of threads that may grow units of a Residency (chunks of fur or skin) at the same time.
/// If most of the units that threads grow were evicted only recently, then the memory is too small for the
/// units that all threads need at once, and the threads evict each other's units. In this case the throttle
/// halves the limit, down to one thread, and the other threads wait. When few of the units that threads grow
/// were evicted recently, the throttle raises the limit step by step.
///
/// While the limit is below the number of threads, only threads with a turn may grow units. There are as many
/// turns as the limit. A thread may lose its turn when the limit is lowered. It also loses its turn when it
/// has grown nothing for kIdleTimeout and another thread asks for a turn. Thus threads do not wait for a
/// thread that needs no more units or has ended. Not thread safe.
class GrowthThrottle {
 public:
  using Clock = std::chrono::steady_clock;
  /// Time without growing after which a thread may lose its turn.
  static constexpr std::chrono::milliseconds kIdleTimeout{500};

  explicit GrowthThrottle(int threads);

  /// Returns whether a thread may grow a unit now. Gives the thread a free turn if it needs one.
  bool may_grow(int thread, Clock::time_point now);
  /// Records that a thread has grown a unit. `again_soon`: whether this unit had been evicted recently.
  void grown(int thread, bool again_soon, Clock::time_point now);
  /// The limit: max number of threads that may grow units at the same time.
  int concurrency() const { return concurrency_; }

 private:
  struct Turn {
    int thread;
    Clock::time_point used;
  };
  void set_concurrency(int count);

  const int threads_;
  int concurrency_;
  int good_ = 0, needed_ = 1;   // count of windows with few repeated growths; count that raises the limit
  int window_ = 0, again_ = 0;  // growths in this window; growths in it of recently evicted units
  std::vector<Turn> turns_;     // empty while all threads may grow
};

}  // namespace pelage
