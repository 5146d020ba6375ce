// SPDX-License-Identifier: Apache-2.0
#include "cache/clock_ring.h"

#include <deque>

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

// The slow truth: a queue whose front is under the hand.
TEST(ClockRing, IsAQueueThatTurns) {
  ClockRing ring(20);
  std::deque<uint32_t> model;
  std::vector<bool> inside(20, false);
  for (uint64_t step = 0; step < 20'000; ++step) {
    const uint64_t random = hash64(7, step);
    const auto number = static_cast<uint32_t>(random % 20);
    if (const uint64_t action = (random >> 32) % 3; action == 0 && !inside[number]) {
      ring.insert(number);
      model.push_back(number);
      inside[number] = true;
    } else if (action == 1 && !model.empty()) {
      const uint32_t removed = ring.remove_hand();
      EXPECT_EQ(removed, model.front());
      model.pop_front();
      inside[removed] = false;
    } else if (action == 2 && !model.empty()) {
      ring.advance();
      model.push_back(model.front());
      model.pop_front();
    }
    ASSERT_EQ(ring.size(), model.size());
    ASSERT_EQ(ring.empty(), model.empty());
    if (!model.empty()) {
      ASSERT_EQ(ring.hand(), model.front()) << step;
    }
  }
}

}  // namespace
}  // namespace pelage
