// SPDX-License-Identifier: Apache-2.0
#include "cache/growth_turns.h"

#include <algorithm>

namespace pelage {
namespace {

/// Growths after which the number of turns is looked at, and the parts of them, in percent, above which there
/// are too many and below which there may be more.
constexpr int kWindow = 64, kTooMany = 75, kFew = 40;
/// Every time that there turned out to be too many, twice as many good windows are wanted before one more is
/// tried, up to this.
constexpr int kMostNeeded = 64;

}  // namespace

GrowthTurns::GrowthTurns(int threads) : threads_(threads), at_once_(threads) {}

bool GrowthTurns::may_grow(int thread, Clock::time_point now) {
  if (at_once_ >= threads_) return true;
  const auto own =
      std::find_if(turns_.begin(), turns_.end(), [&](const Turn& t) { return t.thread == thread; });
  if (own != turns_.end()) return true;
  std::erase_if(turns_, [&](const Turn& t) { return now - t.used > kPatience; });
  if (static_cast<int>(turns_.size()) >= at_once_) return false;
  turns_.push_back({thread, now});
  return true;
}

void GrowthTurns::grown(int thread, bool again_soon, Clock::time_point now) {
  for (Turn& turn : turns_) {
    if (turn.thread == thread) turn.used = now;
  }
  again_ += again_soon ? 1 : 0;
  if (++window_ < kWindow) return;
  if (100 * again_ > kTooMany * kWindow && at_once_ > 1) {
    set_at_once(at_once_ / 2);
    good_ = 0;
    needed_ = std::min(2 * needed_, kMostNeeded);
  } else if (100 * again_ < kFew * kWindow && at_once_ < threads_ && ++good_ >= needed_) {
    set_at_once(at_once_ + 1);
    good_ = 0;
  }
  window_ = again_ = 0;
}

void GrowthTurns::set_at_once(int count) {
  at_once_ = count;
  if (at_once_ >= threads_) turns_.clear();
  // Who used it last has the most to lose.
  std::sort(turns_.begin(), turns_.end(), [](const Turn& a, const Turn& b) { return a.used > b.used; });
  if (static_cast<int>(turns_.size()) > at_once_) turns_.resize(static_cast<size_t>(at_once_), {0, {}});
}

}  // namespace pelage
