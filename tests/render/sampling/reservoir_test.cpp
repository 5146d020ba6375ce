// SPDX-License-Identifier: Apache-2.0
#include "render/sampling/reservoir.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(Reservoir, ChoosesEachItemInProportionToItsMass) {
  const float masses[] = {0.5f, 0, 2, 0.25f, 1.25f};
  constexpr int kTrials = 100000;
  int chosen[5] = {};
  for (int trial = 0; trial < kTrials; ++trial) {
    Reservoir reservoir((static_cast<float>(trial) + 0.5f) / kTrials);
    int last = -1;
    for (int i = 0; i < 5; ++i) {
      if (reservoir.takes(masses[i])) last = i;
    }
    ASSERT_GE(last, 0);
    ++chosen[last];
    EXPECT_EQ(reservoir.sum(), 4);
  }
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(chosen[i] * 4.0 / kTrials, masses[i], 2e-3) << i;
}

TEST(Reservoir, StaysEmptyWithoutMass) {
  Reservoir reservoir(0.3f);
  EXPECT_FALSE(reservoir.takes(0));
  EXPECT_EQ(reservoir.sum(), 0);
  EXPECT_TRUE(reservoir.takes(1)) << "the first item with mass";
}

}  // namespace
}  // namespace pelage
