// SPDX-License-Identifier: Apache-2.0
#include "render/gather/depth_profile.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

DepthPlace place_at(float depth, uint32_t coat = 0) {
  const float zones = depth * kZonesOfCoat - 0.5f;
  const float below = std::clamp(std::floor(zones), 0.0f, kZonesOfCoat - 2.0f);
  return {coat * kZonesOfCoat + static_cast<uint32_t>(below), zones - below};
}

/// Adds rays of gather points, each within an eighth of a strand. From the root to the tip, the fraction that
/// arrives rises from `root` to 4 times `root`; gather points near the root get `open` times as much, as if
/// only open places showed their roots.
void add(DepthProfile& profile, uint32_t gather_points, float root, float open) {
  for (uint32_t g = 0; g < gather_points; ++g) {
    const float middle = unit_float(hash64(g, random_use("middle")));
    const float more = open + (1 - open) * middle;
    for (uint32_t i = 0; i < 16; ++i) {
      const float offset = 0.25f * (unit_float(hash64(g, i, random_use("offset"))) - 0.5f);
      const float depth = std::clamp(middle + offset, 0.0f, 1.0f);
      const float fraction = root * more * std::exp2(2 * depth);
      profile.add(g, place_at(depth), 0, 1, unit_float(hash64(g, i, random_use("ray"))) < fraction ? 1 : 0);
    }
  }
}

TEST(DepthProfile, IsFlatUntilItLearns) {
  DepthProfile profile;
  profile.begin(2);
  add(profile, 100, 0.2f, 1);
  EXPECT_EQ(profile.at(place_at(0.9f), 0), 1);
  profile.learn();
  EXPECT_GT(profile.at(place_at(0.9f), 0), 1.1f);
  EXPECT_EQ(profile.at(place_at(0.9f), 1), 1) << "no light of this source was added";
  profile.begin(2);
  EXPECT_EQ(profile.at(place_at(0.9f), 0), 1);
}

TEST(DepthProfile, FollowsTheLightAlongAStrandWhateverOtherStrandsGet) {
  for (const float open : {1.0f, 2.0f, 3.0f}) {
    DepthProfile profile;
    profile.begin(1);
    add(profile, 20000, 0.08f, open);
    profile.learn();
    for (float depth = 0.2f; depth < 0.81f; depth += 0.2f) {
      const float rise = profile.at(place_at(depth + 0.06f), 0) / profile.at(place_at(depth - 0.06f), 0);
      EXPECT_NEAR(rise, std::exp2(0.24f), 0.05f) << open << ", " << depth;
    }
  }
}

TEST(DepthProfile, FewRaysChangeLittle) {
  DepthProfile profile;
  profile.begin(1);
  profile.add(0, place_at(0.45f), 0, 1, 0);
  profile.add(0, place_at(0.55f), 0, 1, 1);
  profile.learn();
  EXPECT_NEAR(profile.at(place_at(0.55f), 0) / profile.at(place_at(0.45f), 0), 1, 0.05f);
}

TEST(DepthProfile, IsPositiveAndFiniteWhereNothingArrives) {
  DepthProfile profile;
  profile.begin(1);
  for (uint32_t i = 0; i < 1000; ++i) {
    profile.add(i / 10, place_at(i % 2 ? 0.45f : 0.55f), 0, 1, i % 2);
    profile.add(1000 + i, place_at(0.1f), 0, 1, 0);
  }
  profile.learn();
  for (float depth = 0; depth <= 1; depth += 0.125f) {
    EXPECT_GT(profile.at(place_at(depth), 0), 0) << depth;
    EXPECT_LT(profile.at(place_at(depth), 0), 1e6f) << depth;
  }
}

/// More coats than a tile keeps apart, all of them steep.
TEST(DepthProfile, StaysWithinBoundsInATileOfManyCoats) {
  for (const bool brighter_at_tips : {true, false}) {
    DepthProfile profile;
    profile.begin(1);
    for (uint32_t i = 0; i < 40 * 500; ++i) {
      const uint32_t coat = i / 500;
      const float depth = unit_float(hash64(i, random_use("depth")));
      for (const float offset : {-0.06f, 0.06f}) {
        const bool tip = offset > 0;
        profile.add(i, place_at(std::clamp(depth + offset, 0.0f, 1.0f), coat), 0, 1, tip == brighter_at_tips);
      }
    }
    profile.learn();
    for (uint32_t coat = 0; coat < 40; ++coat) {
      const float root = profile.at(place_at(0, coat), 0), tip = profile.at(place_at(1, coat), 0);
      EXPECT_GT(brighter_at_tips ? tip / root : root / tip, 100) << coat;
      for (const float value : {root, tip}) {
        EXPECT_GT(value, 1e-5f) << coat;
        EXPECT_LT(value, 1e5f) << coat;
      }
    }
  }
}

}  // namespace
}  // namespace pelage
