// SPDX-License-Identifier: Apache-2.0
#include "groom/sim/dynamics_params.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(DynamicsParams, GuidesFollowTheNumberOfStrands) {
  DynamicsParams params;
  EXPECT_EQ(params.guide_count(100), 50u);
  EXPECT_EQ(params.guide_count(40000), 400u);
  EXPECT_EQ(params.guide_count(1000000), 2000u);
  params.mode = DynamicsMode::kKinematic;
  EXPECT_EQ(params.guide_count(100), 50u);
  EXPECT_EQ(params.guide_count(40000), 100u);
  EXPECT_EQ(params.guide_count(1000000), 500u);
  params.guides = 7;
  EXPECT_EQ(params.guide_count(1000000), 7u);
}

}  // namespace
}  // namespace pelage
