// SPDX-License-Identifier: Apache-2.0
#include "geom/root_detail.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

Strands three_strands() {
  StrandArrays a;
  a.points.assign(size_t(4) * 6, 0.5f);
  a.first_point = {0, 2, 4, 6};
  a.ids = {5, 6, 7};
  return Strands(std::move(a));
}

TEST(RootDetail, GoesWithItsStrand) {
  const V3f up(0, 1, 0), across(1, 0, 0);
  const Strands strands = RootDetail::added(three_strands(), {{up, 1}, {across, 0.04f}, {up, 0.5f}});
  const auto second = RootDetail::of(strands, 1);
  ASSERT_TRUE(second);
  EXPECT_NEAR(std::abs(second->normal().dot(across)), 1, 2e-4f);  // a degree
  EXPECT_NEAR(second->share(), 0.04f, 0.04f * 2 / 51);            // half a step of the root, 1 / 510 of 0.2
  EXPECT_EQ(RootDetail::of(strands, 0)->share(), 1);
  Strands alone;
  alone.assign_strand(strands, 1);
  EXPECT_EQ(RootDetail::of(alone, 0)->share(), second->share());
  EXPECT_EQ(RootDetail::of(alone, 0)->normal(), second->normal());
}

TEST(RootDetail, IsNotThereUnlessItWasAdded) { EXPECT_FALSE(RootDetail::of(three_strands(), 0)); }

}  // namespace
}  // namespace pelage
