// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/width.h"

#include "tests/groom/operator_harness.h"

namespace pelage {
namespace {

using WidthTest = OperatorTest;

TEST_F(WidthTest, DiametersGoFromRootToTip) {
  const Width op = prepared<Width>({.root = Field(0.08f), .tip = Field(0.01f), .profile = 2, .variation = 0});
  auto batch = straight();
  op.apply(*batch);
  for (int p = 0; p < 8; ++p) {
    const float v = static_cast<float>(p) / 7;
    EXPECT_NEAR(batch->points[static_cast<size_t>(p)].radius[5], 0.5f * (0.08f - 0.07f * v * v), 1e-6f);
  }
  EXPECT_FLOAT_EQ(op.reach_after({}).radius, 0.04f);
}

TEST_F(WidthTest, VariationMakesStrandsThinner) {
  const Width op =
      prepared<Width>({.root = Field(0.1f), .tip = Field(0.1f), .profile = 1, .variation = 0.5f});
  auto batch = straight();
  op.apply(*batch);
  const StrandRow& radius = batch->points[3].radius;
  const auto [low, high] =
      std::minmax_element(radius.begin(), radius.begin() + static_cast<int>(batch->count));
  EXPECT_NEAR(*low, 0.025f, 0.001f);
  EXPECT_NEAR(*high, 0.05f, 0.001f);
}

}  // namespace
}  // namespace pelage
