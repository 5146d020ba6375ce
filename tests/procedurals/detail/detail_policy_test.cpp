// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/detail_policy.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/procedurals/random_coats.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

const V2f kOpen(-0.25f, 0.25f), kClosed(0, 0);

TEST(DetailPolicy, MeasuresHowACoatLiesOnceAndOnlyForMotionBlur) {
  const RandomCoat coat(3, {});
  QuietJob quiet;
  const Job job = quiet;
  SimplificationParams params;
  DetailPolicy blurred(params, LodView(), kOpen, job), sharp(params, LodView(), kClosed, job);
  const auto direction = blurred.direction(*coat.groom, coat.rest);
  ASSERT_TRUE(direction);
  EXPECT_EQ(blurred.direction(*coat.groom, coat.rest), direction);
  EXPECT_FALSE(sharp.direction(*coat.groom, coat.rest));
  params.motion_blur = false;
  EXPECT_FALSE(DetailPolicy(params, LodView(), kOpen, job).direction(*coat.groom, coat.rest));
}

/// Ten times as large and ten times as far away is the same picture.
TEST(DetailPolicy, ScalesStrandsWithTheirCharacter) {
  const RandomCoat coat(4, {});
  QuietJob quiet;
  const Job job = quiet;
  const auto share = [&](float scale, float distance) {
    MemoryLedger ledger;
    CharacterPose pose;
    pose.topology = coat.rest->shared_topology();
    pose.shutter.cages.push_back(shapes::ball_cage(2).positions);
    pose.shutter.transforms.emplace_back();
    pose.scale = scale;
    const PosedCharacterSkin skin(std::move(pose), std::make_shared<PoseCache>(2, ledger));
    SimplificationParams params;
    params.motion_blur = params.depth_of_field = params.back_facing = false;
    LodView view;
    view.open.position = view.close.position = V3f(0, 0, distance);
    view.open.focal_pixels = view.close.focal_pixels = 300;
    const Simplification lod =
        DetailPolicy(params, view, kClosed, job).simplification(*coat.groom, coat.rest.get(), skin);
    return lod.share({V3f(0), V3f(0), V3f(0, 0, 1), V3f(0)});
  };
  const float near = share(1, 30);
  EXPECT_GT(near, 0);
  EXPECT_LT(near, 1);
  EXPECT_NEAR(share(10, 300), near, 1e-4f);
  EXPECT_LT(share(1, 300), near);
}

}  // namespace
}  // namespace pelage
