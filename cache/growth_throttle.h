// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <vector>

namespace pelage {

/// How many threads may grow units at once. Where most of what is grown had been dropped only just before,
/// the threads take each other's units away: all that each of them needs for a while does not fit together.
/// Then fewer may grow, down to one, and the others wait; where that is no longer so, more.
///
/// A turn is kept as long as it is used: who has grown nothing for a while has lost it, so that nobody waits
/// for a thread that has all it needs, or has ended. Not thread safe.
class GrowthThrottle {
 public:
  using Clock = std::chrono::steady_clock;
  /// A turn that was not used for so long is free.
  static constexpr std::chrono::milliseconds kIdleTimeout{500};

  explicit GrowthThrottle(int threads);

  /// Whether a thread may grow something now; it has a turn from then on.
  bool may_grow(int thread, Clock::time_point now);
  /// A thread has grown something; `again_soon`: what had been dropped only just before.
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
  int good_ = 0, needed_ = 1;   // windows since in which there could have been more; how many it takes
  int window_ = 0, again_ = 0;  // growths since the number was last looked at; of these, again soon
  std::vector<Turn> turns_;     // empty while everybody may grow
};

}  // namespace pelage
