// SPDX-License-Identifier: Apache-2.0
#include "render/sampling/systematic_choice.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

TEST(SystematicChoice, ChoosesEveryRunOfItemsAsOftenAsItsMassSays) {
  for (uint64_t trial = 0; trial < 50; ++trial) {
    const double step = 0.1 + unit_float(hash64(trial, random_use("step")));
    SystematicChoice choice(step, unit_float(hash64(trial, random_use("u"))));
    std::vector<double> masses;
    std::vector<uint32_t> times;
    for (uint64_t i = 0; i < 40; ++i) {
      masses.push_back(i % 5 == 0 ? 0.0 : 2 * unit_float(hash64(trial, i)));
      times.push_back(choice.times(masses.back()));
      EXPECT_TRUE(masses.back() > 0 || times.back() == 0);
    }
    for (size_t begin = 0; begin < masses.size(); ++begin) {
      double mass = 0, chosen = 0;
      for (size_t i = begin; i < masses.size(); ++i) {
        mass += masses[i];
        chosen += times[i];
        ASSERT_LT(std::abs(chosen - mass / step), 1 + 1e-9) << trial << ": " << begin << " to " << i;
      }
    }
  }
}

TEST(SystematicChoice, ChoosesAnItemInProportionToItsMassOnAverage) {
  const double masses[] = {0.3, 1.7, 0.05, 0.95};
  double times[4] = {};
  constexpr int kTrials = 10000;
  for (int trial = 0; trial < kTrials; ++trial) {
    SystematicChoice choice(0.8, (trial + 0.5) / kTrials);
    for (size_t i = 0; i < 4; ++i) times[i] += choice.times(masses[i]);
  }
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(times[i] / kTrials, masses[i] / 0.8, 2e-4) << i;
}

}  // namespace
}  // namespace pelage
