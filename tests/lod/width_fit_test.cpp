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

}  // namespace
}  // namespace pelage
