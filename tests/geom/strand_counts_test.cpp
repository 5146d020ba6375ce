// SPDX-License-Identifier: Apache-2.0
#include "geom/strand_counts.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(StrandCounts, AddUpButForTheLongestStrandAndTheMotionKeys) {
  StrandCounts sum;
  for (const size_t points : {4, 9, 6}) {
    sum += {.strands = 2,
            .points = 2 * points,
            .longest = points,
            .segments = 2 * (points - 1),
            .motion_keys = points == 9 ? 3u : 1u,
            .attribute_floats = 10};
  }
  EXPECT_EQ(sum.strands, 6u);
  EXPECT_EQ(sum.points, 38u);
  EXPECT_EQ(sum.longest, 9u);
  EXPECT_EQ(sum.segments, 32u);
  EXPECT_EQ(sum.motion_keys, 3u);
  EXPECT_EQ(sum.attribute_floats, 30u);
}

}  // namespace
}  // namespace pelage
