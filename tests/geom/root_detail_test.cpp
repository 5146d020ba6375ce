// SPDX-License-Identifier: Apache-2.0
#include "geom/root_detail.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/hash.h"

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

TEST(PackedLine, ComesBackWithinADegree) {
  float worst = 1;
  for (uint64_t i = 0; i < 20000; ++i) {
    const float z = 2 * unit_float(hash64(i, 1)) - 1, angle = 6.2831853f * unit_float(hash64(i, 2));
    const float r = std::sqrt(1 - z * z);
    const V3f line(r * std::cos(angle), r * std::sin(angle), z);
    const V2f packed = packed_line(line);
    EXPECT_EQ(packed, packed_line(-line));
    for (const float x : {packed.x, packed.y}) {
      EXPECT_GE(x, 0);
      EXPECT_LE(x, 1);
      EXPECT_EQ(x, std::round(255 * x) / 255);
    }
    EXPECT_NEAR(unpacked_line(packed).length(), 1, 1e-5f);
    worst = std::min(worst, std::abs(unpacked_line(packed).dot(line)));
  }
  EXPECT_GT(worst, std::cos(0.0175f));
}

TEST(PackedLine, AxesAreExact) {
  for (const V3f& axis : {V3f(0, 0, 1), V3f(1, 0, 0), V3f(0, 1, 0)})
    EXPECT_NEAR(std::abs(unpacked_line(packed_line(axis)).dot(axis)), 1, 1e-4f);
}

}  // namespace
}  // namespace pelage
