// SPDX-License-Identifier: Apache-2.0
#include "lod/width_fit.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(WidthFit, IsOneUntilItIsMeasured) {
  for (const float share : {1.0f, 0.5f, 0.01f, 1e-6f}) EXPECT_EQ(WidthFit().at(share), 1);
}

TEST(WidthFit, IsLinearInTheLogarithmOfTheShare) {
  const WidthFit fit{{1, 0.9f, 0.7f, 0.5f}};
  EXPECT_EQ(fit.at(1), 1);
  EXPECT_FLOAT_EQ(fit.at(0.25f), 0.9f);
  EXPECT_FLOAT_EQ(fit.at(0.125f), 0.8f);
  EXPECT_FLOAT_EQ(fit.at(1 / 16.0f), 0.7f);
  EXPECT_FLOAT_EQ(fit.at(1 / 64.0f), 0.5f);
  EXPECT_FLOAT_EQ(fit.at(1e-5f), 0.5f) << "constant beyond";
}

TEST(WidthFit, RangesEndAtTheKnotsOfBothCoats) {
  const WidthFit fit{{1, 0.9f, 1.4f, 0.5f}};
  for (const float fraction : {0.25f, 0.125f}) {
    float share = 1e-4f, last = fit.ratio(share, fraction);
    while (share < 1) {
      const float end = fit.end_of_range(share, fraction), first = last;
      ASSERT_GT(end, share);
      last = fit.ratio(end, fraction);
      for (float at = share; at < end; at *= 1.01f) {
        EXPECT_GE(fit.ratio(at, fraction), std::min(first, last) * (1 - 1e-5f)) << at;
        EXPECT_LE(fit.ratio(at, fraction), std::max(first, last) * (1 + 1e-5f)) << at;
      }
      share = end;
    }
  }
  EXPECT_EQ(fit.ratio(1, 0.25f), 1);
  EXPECT_FLOAT_EQ(fit.ratio(0.25f, 0.25f), 0.9f);
  EXPECT_FLOAT_EQ(fit.ratio(1 / 16.0f, 0.25f), 1.4f / 0.9f);
}

}  // namespace
}  // namespace pelage
