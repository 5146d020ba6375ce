// SPDX-License-Identifier: Apache-2.0
#include "cache/growth_throttle.h"

#include <algorithm>

namespace pelage {
namespace {

/// Growths after which the limit is reconsidered, and the percentages of repeated growths above which it is
/// lowered and below which it may be raised.
constexpr int kWindow = 64, kTooMany = 75, kFew = 40;
/// Whenever the limit had to be lowered, the number of good windows needed before it is raised again doubles,
/// up to this.
constexpr int kMaxNeeded = 64;

}  // namespace

GrowthThrottle::GrowthThrottle(int threads) : threads_(threads), concurrency_(threads) {}

bool GrowthThrottle::may_grow(int thread, Clock::time_point now) {
  if (concurrency_ >= threads_) return true;
  const auto own =
      std::find_if(turns_.begin(), turns_.end(), [&](const Turn& t) { return t.thread == thread; });
  if (own != turns_.end()) return true;
  std::erase_if(turns_, [&](const Turn& t) { return now - t.used > kIdleTimeout; });
  if (static_cast<int>(turns_.size()) >= concurrency_) return false;
  turns_.push_back({thread, now});
  return true;
}

void GrowthThrottle::grown(int thread, bool again_soon, Clock::time_point now) {
  for (Turn& turn : turns_) {
    if (turn.thread == thread) turn.used = now;
  }
  again_ += again_soon ? 1 : 0;
  if (++window_ < kWindow) return;
  if (100 * again_ > kTooMany * kWindow && concurrency_ > 1) {
    set_concurrency(concurrency_ / 2);
    good_ = 0;
    needed_ = std::min(2 * needed_, kMaxNeeded);
  } else if (100 * again_ < kFew * kWindow && concurrency_ < threads_ && ++good_ >= needed_) {
    set_concurrency(concurrency_ + 1);
    good_ = 0;
  }
  window_ = again_ = 0;
}

void GrowthThrottle::set_concurrency(int count) {
  concurrency_ = count;
  if (concurrency_ >= threads_) turns_.clear();
  // Threads that used their turn most recently keep it.
  std::sort(turns_.begin(), turns_.end(), [](const Turn& a, const Turn& b) { return a.used > b.used; });
  if (static_cast<int>(turns_.size()) > concurrency_)
    turns_.resize(static_cast<size_t>(concurrency_), {0, {}});
}

}  // namespace pelage
