// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/guide_turns.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(GuideTurns, BlendTheShortWay) {
  const GuideTurns a{0, 0, 0, 1, 0.6f, 0, 0, 0.8f}, b{0, 1, 0, 0, -0.6f, 0, 0, -0.8f};
  EXPECT_EQ(blend_turns(a, b, 0), a);
  // The second segment has the same rotation in both, with opposite signs.
  EXPECT_EQ(blend_turns(a, b, 0.5f), (GuideTurns{0, 0.5f, 0, 0.5f, 0.6f, 0, 0, 0.8f}));
  EXPECT_EQ(blend_turns(a, b, 1), (GuideTurns{0, 1, 0, 0, 0.6f, 0, 0, 0.8f}));
}

}  // namespace
}  // namespace pelage
