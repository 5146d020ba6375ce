// SPDX-License-Identifier: Apache-2.0
#include "render/gather/arrival_guess.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "render/sampling/warp.h"

namespace pelage {
namespace {

const V3f kUp(0, 1, 0), kDown(0, -1, 0);

V3f direction(uint64_t i) { return uniform_direction({unit_float(hash64(i, 1)), unit_float(hash64(i, 2))}); }

TEST(ArrivalGuess, RangesDivideTheSphereEvenly) {
  constexpr uint64_t kDirections = 48000;
  std::vector<int> found(ArrivalGuess::kRanges);
  for (uint64_t i = 0; i < kDirections; ++i) ++found.at(ArrivalGuess::range_of(direction(i)));
  // Expected 2000 each; 5 standard deviations.
  for (const int count : found) EXPECT_NEAR(count, 2000, 220);
  EXPECT_NE(ArrivalGuess::range_of(kUp), ArrivalGuess::range_of(kDown));
}

/// In zone 0, a quarter of the light arrives from above and nothing from below; in zone 1, all.
ArrivalGuess learned() {
  ArrivalGuess guess;
  guess.begin(2);
  for (int i = 0; i < 400; ++i) {
    guess.add(0, 0, ArrivalGuess::range_of(kUp), 2, i % 4 == 0 ? 1.0f : 0.0f);
    guess.add(0, 0, ArrivalGuess::range_of(kDown), 1, 0);
    guess.add(1, 0, ArrivalGuess::range_of(kUp), 1, 1);
  }
  return guess;
}

TEST(ArrivalGuess, LearnsTheFractionByZoneAndDirection) {
  ArrivalGuess guess = learned();
  const uint32_t up = ArrivalGuess::range_of(kUp), down = ArrivalGuess::range_of(kDown);
  EXPECT_EQ(guess.fraction(0, 0, up), 0.0f) << "nothing is known";
  EXPECT_EQ(guess.deviation(0, 0, up), 1.0f);
  guess.learn();
  EXPECT_NEAR(guess.fraction(0, 0, up), 0.25f, 0.005f);
  EXPECT_LT(guess.fraction(0, 0, down), 0.005f);
  EXPECT_NEAR(guess.fraction(1, 0, down), 1.0f, 1e-6f) << "as in the other directions of the zone";
  EXPECT_NEAR(guess.fraction(7, 0, up), 600.0f / 1600, 1e-4f) << "as in the zones that are known";
  EXPECT_EQ(guess.fraction(0, 1, up), 0.0f) << "a light without rays";
  EXPECT_NEAR(guess.deviation(0, 0, up), std::sqrt(0.25f * 0.75f), 0.01f);
  EXPECT_GT(guess.deviation(0, 0, down), 0.1f) << "no ray is given up";
  EXPECT_LT(guess.deviation(0, 0, down), 0.2f);
  guess.begin(2);
  EXPECT_EQ(guess.fraction(0, 0, up), 0.0f) << "the next tile";
}

TEST(ArrivalGuess, RejectsWhereNoRayArrived) {
  ArrivalGuess guess = learned();
  const uint32_t up = ArrivalGuess::range_of(kUp), down = ArrivalGuess::range_of(kDown);
  guess.learn(true);
  EXPECT_EQ(guess.deviation(0, 0, down), 0.0f);
  EXPECT_EQ(guess.fraction(0, 0, down), 0.0f);
  EXPECT_NEAR(guess.deviation(0, 0, up), std::sqrt(0.25f * 0.75f), 0.01f) << "some rays arrived";
  EXPECT_GT(guess.deviation(1, 0, down), 0.0f) << "no rays";
  EXPECT_GT(guess.deviation(7, 0, down), 0.0f) << "an unknown zone";
}

TEST(ArrivalGuess, LeavesRaysOut) {
  const ArrivalGuess guess = learned();
  const uint32_t up = ArrivalGuess::range_of(kUp);
  ArrivalGuess::Sums arrived;  // all rays that arrive in zone 0
  for (int i = 0; i < 100; ++i) arrived.add(2, 1);
  EXPECT_NEAR(guess.fraction_without(0, 0, up, {}, {}), 0.25f, 0.005f);
  EXPECT_EQ(guess.fraction_without(0, 0, up, arrived, arrived), 0.0f);
  ArrivalGuess::Sums all;
  for (int i = 0; i < 400; ++i) all.add(1, 1);
  EXPECT_EQ(guess.fraction_without(1, 0, up, all, all), 0.0f) << "no ray is left";
}

TEST(ArrivalGuess, ZonesBeyondTheLimitShare) {
  ArrivalGuess guess;
  guess.begin(1);
  for (int i = 0; i < 100; ++i) guess.add(static_cast<uint32_t>(3 + kZonesOfTile), 0, 0, 1, 1);
  guess.learn();
  EXPECT_NEAR(guess.fraction(3, 0, 0), 1.0f, 1e-6f);
}

}  // namespace
}  // namespace pelage
