// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/packed_radiance.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

TEST(PackedRadiance, KeepsEachChannelInAnyUnit) {
  double sum = 0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    Rgb radiance;
    for (int c = 0; c < 3; ++c) {
      const uint64_t random = hash64(uint64_t(i), uint64_t(c));
      radiance[c] = std::ldexp(1 + unit_float(random), static_cast<int>(random % 250) - 125);
    }
    const Rgb kept = PackedRadiance::unpack(PackedRadiance::pack(radiance));
    for (int c = 0; c < 3; ++c) {
      const double error = double{kept[c]} / radiance[c] - 1;
      ASSERT_LE(std::abs(error), 0x1p-14);
      sum += error;
    }
  }
  EXPECT_LT(std::abs(sum / (3 * kCount)), 0x1p-14 * 4 / std::sqrt(3.0 * kCount)) << "not one-sided";
}

TEST(PackedRadiance, StaysFiniteAndNotNegative) {
  const auto kept = [](float value) {
    return PackedRadiance::unpack(PackedRadiance::pack(Rgb(1, value, 2)));
  };
  EXPECT_EQ(kept(0), Rgb(1, 0, 2));
  EXPECT_EQ(kept(-3), Rgb(1, 0, 2));
  EXPECT_EQ(kept(std::nanf("")), Rgb(1, 0, 2));
  EXPECT_TRUE(std::isfinite(kept(std::numeric_limits<float>::max()).y));
  EXPECT_TRUE(std::isfinite(kept(std::numeric_limits<float>::infinity()).y));
}

}  // namespace
}  // namespace pelage
