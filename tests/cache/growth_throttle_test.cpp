// SPDX-License-Identifier: Apache-2.0
#include "cache/growth_throttle.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

using namespace std::chrono_literals;

class GrowthThrottleTest : public testing::Test {
 protected:
  /// Lets threads grow one after the other, each if it may; of every ten growths, so many are again soon.
  void grow(int growths, int again_of_ten) {
    for (int i = 0; i < growths; now_ += 1ms) {
      const int thread = i % 4;
      if (throttle_.may_grow(thread, now_)) throttle_.grown(thread, i % 10 < again_of_ten, now_);
      ++i;
    }
  }
  int allowed() {
    int count = 0;
    for (int thread = 0; thread < 4; ++thread) count += throttle_.may_grow(thread, now_) ? 1 : 0;
    return count;
  }

  GrowthThrottle throttle_{4};
  GrowthThrottle::Clock::time_point now_{};
};

TEST_F(GrowthThrottleTest, EverybodyMayGrowWhereUnitsStay) {
  grow(10000, 4);
  EXPECT_EQ(throttle_.concurrency(), 4);
  EXPECT_EQ(allowed(), 4);
}

TEST_F(GrowthThrottleTest, FewerMayWhereTheyTakeEachOthersUnits) {
  grow(10000, 9);
  EXPECT_EQ(throttle_.concurrency(), 1);
  EXPECT_EQ(allowed(), 1);
}

TEST_F(GrowthThrottleTest, MoreMayOnceItIsOver) {
  grow(10000, 9);
  grow(10000, 0);
  EXPECT_EQ(throttle_.concurrency(), 4);
}

TEST_F(GrowthThrottleTest, WhoGrowsNothingLosesItsTurn) {
  grow(10000, 9);
  int holder = 0;
  while (!throttle_.may_grow(holder, now_)) ++holder;
  const int other = (holder + 1) % 4;
  EXPECT_FALSE(throttle_.may_grow(other, now_ + GrowthThrottle::kIdleTimeout / 2));
  throttle_.grown(holder, true, now_ + GrowthThrottle::kIdleTimeout / 2);
  EXPECT_FALSE(throttle_.may_grow(other, now_ + GrowthThrottle::kIdleTimeout + 1ms));
  EXPECT_TRUE(throttle_.may_grow(other, now_ + 2 * GrowthThrottle::kIdleTimeout));
  EXPECT_FALSE(throttle_.may_grow(holder, now_ + 2 * GrowthThrottle::kIdleTimeout));
}

TEST_F(GrowthThrottleTest, OneThreadAlwaysMay) {
  GrowthThrottle alone(1);
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(alone.may_grow(0, now_));
    alone.grown(0, true, now_);
  }
}

}  // namespace
}  // namespace pelage
