// SPDX-License-Identifier: Apache-2.0
#include "render/weighted_selection.h"

#include <vector>

#include <gtest/gtest.h>

namespace pelage::weighted_selection_test {
namespace {

TEST(WeightedSelection, AFewItemsAreAllSelectedOnce) {
  const double weights[] = {3, 0, 5};
  const auto all = select_by_weight(weights, 3);
  ASSERT_EQ(all.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(all[i].index, i);
    EXPECT_EQ(all[i].scale, 1);
  }
  EXPECT_TRUE(select_by_weight({}, 4).empty());
}

TEST(WeightedSelection, EstimatesASumOfWhatIsProportionalToTheWeight) {
  std::vector<double> weights;
  double sum = 0;
  for (int i = 0; i < 100; ++i) sum += weights.emplace_back(1 + i % 7);
  double estimate = 0, shares = 0;
  for (const SelectedItem& item : select_by_weight(weights, 9)) {
    estimate += 2 * weights[item.index] * item.scale;
    shares += item.share;
  }
  EXPECT_NEAR(estimate, 2 * sum, 1e-9 * sum);
  EXPECT_NEAR(shares, 1, 1e-12);
}

TEST(WeightedSelection, AHeavyItemIsSelectedSeveralTimesAndOneWithoutWeightNever) {
  const double weights[] = {0, 90, 0, 5, 5};
  double share = 0;
  for (const SelectedItem& item : select_by_weight(weights, 4)) {
    EXPECT_GT(weights[item.index], 0);
    if (item.index == 1) share = item.share;
  }
  EXPECT_EQ(share, 1);
}

}  // namespace
}  // namespace pelage::weighted_selection_test
