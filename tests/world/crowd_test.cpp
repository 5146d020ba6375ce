// SPDX-License-Identifier: Apache-2.0
// Crowds in the world of a frame.
#include <set>

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "procedurals/skin/posed_character_skin.h"
#include "tests/support/quiet_job.h"
#include "tests/world/small_scene.h"
#include "world/compose.h"

namespace pelage {
namespace {

class CrowdCompositionTest : public testing::Test {
 protected:
  World compose_frame(double frame, std::vector<Override> overrides = {}) {
    overrides.push_back({"camera.shutter", "[0, 0]"});
    description_ = load_scene(scene_.path("scene.yaml"), overrides);
    assets_ = load_assets(description_, QuietJob(2, ledger_));
    return compose(description_, *assets_, frame, QuietJob(2, ledger_));
  }
  static Override crowd(const std::string& keys) {
    return {"crowds.herd",
            "{of: [walker], count: 20, area: {type: disc, radius: 40}, spacing: 4, " + keys + "}"};
  }
  static size_t count_named(const World& world, const std::string& start) {
    size_t count = 0;
    for (const SkinPart& skin : world.scene.skins) count += skin.name.starts_with(start);
    return count;
  }
  static V3f size_of(const World& world, size_t skin) {
    return world.scene.skins[skin].skin->bound({}, BoundSpan::kShutter).size();
  }

  SmallScene scene_;
  Workers workers_{2};
  MemoryLedger ledger_;
  SceneDescription description_;
  std::unique_ptr<Assets> assets_;
};

TEST_F(CrowdCompositionTest, APrototypeIsNotDrawnByItself) {
  const World world = compose_frame(1, {crowd("seed: 1")});
  EXPECT_EQ(count_named(world, "walker"), 0u);
  EXPECT_EQ(count_named(world, "post"), 1u);
  EXPECT_EQ(count_named(world, "herd."), 20u);
  EXPECT_EQ(world.scene.fur.size(), 20u);
  EXPECT_EQ(world.scene.fur[7].name, "herd.7.coat");
  EXPECT_EQ(world.counts.strands_described, 20 * 400);
  const World both = compose_frame(1, {crowd("seed: 1"), {"characters.walker.drawn", "true"}});
  EXPECT_EQ(count_named(both, "walker"), 1u);
  EXPECT_EQ(count_named(compose_frame(1, {{"characters.post.drawn", "false"}}), "post"), 0u);
}

TEST_F(CrowdCompositionTest, EveryPosedCageIsItsOwn) {
  const World world = compose_frame(1, {crowd("heading: {variation: 0}, phase: {value: 1, variation: 1}")});
  std::set<std::pair<uint64_t, uint64_t>> hashes;
  for (const SkinPart& part : world.scene.skins) {
    const auto* skin = dynamic_cast<const PosedCharacterSkin*>(part.skin.get());
    ASSERT_TRUE(skin);
    hashes.emplace(skin->hash().low, skin->hash().high);
  }
  EXPECT_EQ(hashes.size(), 21u);
  EXPECT_EQ(world.counts.strands_unique, world.counts.strands_described);
}

TEST_F(CrowdCompositionTest, CoatsOfEqualPosesAreUniqueOnce) {
  const World world = compose_frame(1, {{"characters.twin",
                                         "{parts: [{skin: cube, material: hide, grooms: {coat: "
                                         "fur}}], transform: {scale: 2, translate: [0, 1, 0]}}"}});
  EXPECT_EQ(world.counts.strands_described, 800);
  EXPECT_EQ(world.counts.strands_unique, 400);
}

TEST_F(CrowdCompositionTest, APartMayHavePosesOfItsOwn) {
  const Override own = {"characters.walker.parts.0.poses", "{files: \"" + scene_.path("cube.%04d.obj") +
                                                               "\", first: 2, count: 2, frames_per_pose: 4}"};
  const auto place_of = [](const World& world) {
    return world.scene.skins[0].skin->bound({}, BoundSpan::kShutter).center().x /
           2;  // the walker is twice as large
  };
  EXPECT_NEAR(place_of(compose_frame(3)), 3, 1e-4f);
  EXPECT_NEAR(place_of(compose_frame(3, {own})), 2.25f, 1e-4f);
}

TEST_F(CrowdCompositionTest, ScalesAndColoursReachWhatIsDrawn) {
  const World world = compose_frame(
      1,
      {crowd("heading: {variation: 0}, scale: {value: 3, axes: [0.2, 0.3, 0.1]}, color: {value: [0.5, 1, 1], "
             "variation: 0.2}")});
  const V3f cube = size_of(compose_frame(1), 0) / 2;  // of the walker, which is twice the cage
  size_t differ = 0;
  for (size_t i = 0; i < 20; ++i) {
    const SkinPart& part = world.scene.skins[i + 1];
    EXPECT_EQ(part.tint, world.scene.fur[i].tint);
    EXPECT_NEAR(part.tint.x / part.tint.y, 0.5f, 1e-5f);
    differ += std::abs(part.tint.y - 1) > 0.02f;
  }
  EXPECT_GT(differ, 12u);
  const V3f size = size_of(world, 1);
  EXPECT_GT(size.x / cube.x, 2 * 3 * 0.79f);
  EXPECT_LT(size.x / cube.x, 2 * 3 * 1.21f);
}

TEST_F(CrowdCompositionTest, StrandsScaleByTheCubeRootOfTheDeterminant) {
  const auto length_of = [](const World& world) {
    const Strands strands = world.scene.fur[0].procedurals[0]->split()[0]->generate();
    return (strands.point(strands.first_point(0) + 4) - strands.point(strands.first_point(0))).length();
  };
  const float plain = length_of(compose_frame(1));  // of a character of scale 2
  const World world = compose_frame(1, {crowd("scale: {value: 1.5, axes: [0.2, 0.3, 0.1]}")});
  const V3f axes = assets_->crowds[0][0].scale;
  EXPECT_NEAR(length_of(world) / plain, std::cbrt(axes.x * axes.y * axes.z),
              0.1f);  // push_out bends a little
}

TEST_F(CrowdCompositionTest, HairIsLongerButNotThicker) {
  const Override plain = {"grooms.coat.operators",
                          "[{length: {value: 0.4}}, {width: {root: 0.02, tip: 0.01}}]"};
  const auto first_of = [&](const std::string& length) {
    return compose_frame(1, {plain, crowd("length: {value: " + length + ", variation: 0.2}")})
        .scene.fur[0]
        .procedurals[0]
        ->split()[0]
        ->generate();
  };
  const Strands one = first_of("1"), three = first_of("3");
  const auto size = [](const Strands& strands) {
    return (strands.point(strands.first_point(0) + 4) - strands.point(strands.first_point(0))).length();
  };
  const float varied = assets_->crowds[0][0].length / 3;
  EXPECT_NE(varied, 1);
  EXPECT_NEAR(size(three) / size(one), 3, 1e-3f);
  EXPECT_EQ(one.point(one.first_point(0)), three.point(three.first_point(0)));
  EXPECT_NEAR(three.radius(three.first_point(0)), one.radius(one.first_point(0)), 1e-6f);
}

TEST_F(CrowdCompositionTest, OnlyWhatTheCameraSeesIsInTheFrame) {
  EXPECT_EQ(compose_frame(1).counts.characters_in_frame, 1);
  const World away = compose_frame(1, {{"camera.look_at", "[1, 0, 30]"}});
  EXPECT_EQ(away.counts.characters_in_frame, 0);
  const World half = compose_frame(1, {crowd("seed: 5"),
                                       {"camera.position", "[0, 2, 0]"},
                                       {"camera.look_at", "[0, 2, -1]"},
                                       {"camera.fov", "90"}});
  EXPECT_GT(half.counts.characters_in_frame, 2);
  EXPECT_LT(half.counts.characters_in_frame, 15);
}

TEST_F(CrowdCompositionTest, SharingATopologyChangesNothingButMemory) {
  const World shared = compose_frame(1, {crowd("seed: 2")});
  const Strands a = shared.scene.fur[3].procedurals[0]->split()[0]->generate();
  const int64_t shared_bytes = ledger_.current(MemoryTag::kSkins);
  MemoryLedger other;
  const SceneDescription scene =
      load_scene(scene_.path("scene.yaml"),
                 {crowd("seed: 2"), {"render.shared_topology", "false"}, {"camera.shutter", "[0, 0]"}});
  const auto assets = load_assets(scene, QuietJob(2, other));
  const World apart = compose(scene, *assets, 1, QuietJob(2, other));
  EXPECT_EQ(a.arrays().points, apart.scene.fur[3].procedurals[0]->split()[0]->generate().arrays().points);
  const auto topology = static_cast<int64_t>(assets->skins.at("cube").rest->topology().bytes());
  EXPECT_GE(other.current(MemoryTag::kSkins), shared_bytes + 19 * topology);
}

}  // namespace
}  // namespace pelage
