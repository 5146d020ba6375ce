// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/waiting_rays.h"

#include <algorithm>
#include <deque>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "tests/render/random.h"

namespace pelage {
namespace {

using UpcomingSteps = WaitingRays::UpcomingSteps;
using Step = WaitingRays::Step;

TEST(WaitingRays, know_the_first_steps_ahead) {
  TestRandom random(5);
  for (size_t count = 1; count < 20; ++count) {
    std::vector<Step> steps;
    // Some entries are equal.
    for (uint32_t t = 0; t < count; ++t) steps.push_back({std::floor(6 * random.unit()), 100 - t});
    UpcomingSteps upcoming;
    for (const Step& step : steps) upcoming.add(step);
    std::sort(steps.begin(), steps.end());
    EXPECT_EQ(upcoming.is_full(), count >= UpcomingSteps::kMaxSteps);
    const size_t kept = std::min(count, UpcomingSteps::kMaxSteps);
    EXPECT_EQ(upcoming.back().treelet, steps[kept - 1].treelet);
    for (size_t i = 0; i < kept; ++i, upcoming.pop()) {
      EXPECT_EQ(upcoming.front().entry, steps[i].entry);
      EXPECT_EQ(upcoming.front().treelet, steps[i].treelet);
    }
    EXPECT_TRUE(upcoming.is_empty());
    EXPECT_EQ(upcoming.last().treelet, steps[kept - 1].treelet);
  }
}

TEST(WaitingRays, take_steps_out_of_turn) {
  UpcomingSteps upcoming;
  for (uint32_t t = 0; t < 4; ++t) upcoming.add({float(t), t});
  upcoming.bring_forward([](uint32_t t) { return t == 3; });
  EXPECT_EQ(upcoming.front().treelet, 3u);
  upcoming.pop();
  upcoming.bring_forward([](uint32_t t) { return t == 3; });
  EXPECT_EQ(upcoming.front().treelet, 1u);
  EXPECT_EQ(upcoming.last().treelet, 3u);
}

/// Against queues that take what memory they like.
TEST(WaitingRays, wait_in_the_queues_of_their_pages) {
  constexpr uint32_t kPages = 5;
  constexpr size_t kRays = 12;
  TestRandom random(6);
  WaitingRays waiting(kPages, kRays);
  std::map<uint32_t, std::deque<uint32_t>> truth;
  size_t held = 0;
  for (uint32_t number = 0; number < 500; ++number) {
    EXPECT_EQ(waiting.is_full(), held == kRays);
    EXPECT_EQ(waiting.is_empty(), held == 0);
    if (!waiting.is_full() && random.unit() < 0.8f) {
      const uint32_t slot = waiting.begin();
      waiting[slot].number = number;
      const auto page = static_cast<uint32_t>(kPages * random.unit() * 0.999f);
      waiting.wait(slot, page);
      truth[page].push_back(number);
      ++held;
      continue;
    }
    if (waiting.is_empty()) continue;
    const uint32_t page = waiting.fullest();
    for (const auto& [other, queue] : truth) EXPECT_LE(queue.size(), truth[page].size()) << other;
    std::vector<uint32_t> numbers;
    for (uint32_t slot = waiting.release(page); slot != WaitingRays::kNone; --held) {
      const uint32_t next = waiting[slot].next;
      numbers.push_back(waiting[slot].number);
      waiting.end(slot);
      slot = next;
    }
    EXPECT_TRUE(std::equal(numbers.begin(), numbers.end(), truth[page].begin(), truth[page].end()));
    truth[page].clear();
  }
  waiting.clear();
  EXPECT_TRUE(waiting.is_empty());
  for (size_t i = 0; i < kRays; ++i) waiting.begin();
  EXPECT_TRUE(waiting.is_full());
}

TEST(WaitingRays, of_no_room_are_full) {
  const WaitingRays none(100, 0);
  EXPECT_TRUE(none.is_full() && none.is_empty());
  EXPECT_EQ(WaitingRays::bytes(100, 0), 0u);
}

}  // namespace
}  // namespace pelage
