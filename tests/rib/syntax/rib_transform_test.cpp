// SPDX-License-Identifier: Apache-2.0
#include "rib/syntax/rib_transform.h"

#include <limits>

#include <gtest/gtest.h>

namespace pelage {
namespace {

M44f translation(float x) { return M44f().setTranslation(V3f(x, 0, 0)); }

TEST(RibTransform, InterpolatesBetweenTimes) {
  const RibTransform moving({{0.0, translation(0)}, {0.5, translation(4)}});
  EXPECT_EQ(moving.at(-1).translation(), V3f(0));
  EXPECT_EQ(moving.at(0.25).translation(), V3f(2, 0, 0));
  EXPECT_EQ(moving.at(2).translation(), V3f(4, 0, 0));
  EXPECT_FALSE(RibTransform(translation(1)).moves());
}

TEST(RibTransform, TheInnerTransformAppliesFirst) {
  const RibTransform outer(M44f().setScale(2.0f)), inner(translation(1));
  EXPECT_EQ(V3f(0) * outer.after(inner).at(0), V3f(2, 0, 0));
  const RibTransform moving({{0.0, translation(0)}, {1.0, translation(1)}});
  const RibTransform both = outer.after(moving);
  EXPECT_EQ(both.sample_count(), 2u);
  EXPECT_EQ(V3f(0) * both.at(1), V3f(2, 0, 0));
  const RibTransform twice = RibTransform({{0.5, translation(0)}, {0.75, translation(2)}}).after(moving);
  EXPECT_EQ(twice.sample_count(), 4u) << "the times of both";
}

TEST(RibTransform, KnowsUnusableMatrices) {
  EXPECT_TRUE(is_usable(M44f()));
  EXPECT_FALSE(is_usable(M44f().setScale(V3f(1, 0, 1))));
  M44f infinite;
  infinite[3][0] = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(is_usable(infinite));
}

}  // namespace
}  // namespace pelage
