// SPDX-License-Identifier: Apache-2.0
#include "world/compose.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "tests/support/quiet_job.h"
#include "tests/world/small_scene.h"

namespace pelage {
namespace {

class ComposeTest : public testing::Test {
 protected:
  World compose_frame(double frame, const std::vector<Override>& overrides = {}) {
    description_ = load_scene(scene_.path("scene.yaml"), overrides);
    assets_ = load_assets(description_, QuietJob(2, ledger_));
    return compose(description_, *assets_, frame, QuietJob(2, ledger_));
  }
  static SkinMesh mesh_of(const World& world, size_t skin) {
    return world.scene.skins[skin].skin->tessellate({}, world.scene.camera.view());
  }
  static Box3f box(const SkinMesh& mesh, int key) {
    Box3f result;
    for (size_t i = 0; i < mesh.vertex_count(); ++i) result.extendBy(mesh.position(i, key));
    return result;
  }

  SmallScene scene_;
  Workers workers_{2};
  MemoryLedger ledger_;
  SceneDescription description_;
  std::unique_ptr<Assets> assets_;
};

TEST_F(ComposeTest, EveryPartOfTheSceneIsInTheWorld) {
  const World world = compose_frame(1);
  ASSERT_EQ(world.scene.skins.size(), 2u);
  EXPECT_EQ(world.scene.skins[0].name, "walker.cube");
  EXPECT_EQ(world.scene.skins[1].name, "post.still");
  ASSERT_EQ(world.scene.fur.size(), 1u);
  EXPECT_EQ(world.scene.fur[0].name, "walker.coat");
  EXPECT_EQ(world.scene.fur[0].material, 1u);
  EXPECT_EQ(world.scene.lights.size(), 2u);
  EXPECT_EQ(world.counts.strands_described, 400);
  EXPECT_EQ(world.counts.characters, 1);  // the post has no coat
  EXPECT_EQ(world.counts.characters_in_frame, 1);
}

TEST_F(ComposeTest, PosesFollowTheShutterAndTheTransform) {
  const World world = compose_frame(2);
  const SkinMesh mesh = mesh_of(world, 0);
  ASSERT_EQ(mesh.motion_keys, 2);
  // Pose 2 stands at x = 2, the shutter reaches a quarter of a frame to both sides, the character is twice as
  // large.
  EXPECT_NEAR(box(mesh, 0).center().x, 2 * 1.75f, 1e-4f);
  EXPECT_NEAR(box(mesh, 1).center().x, 2 * 2.25f, 1e-4f);
  EXPECT_NEAR(box(mesh, 0).center().y, 1, 1e-4f);
  EXPECT_EQ(mesh_of(world, 1).motion_keys, 1);  // what stands still has one key

  const auto leaves = world.scene.fur[0].procedurals[0]->split();
  ASSERT_FALSE(leaves.empty());
  const Strands strands = leaves[0]->generate();
  EXPECT_EQ(strands.motion_keys(), 2);
  const V3f root = strands.point(strands.first_point(0), 0),
            tip = strands.point(strands.first_point(0) + 4, 0);
  EXPECT_NEAR((tip - root).length(), 0.8f,
              0.15f);  // lengths scale with the character; push_out may bend a little
}

TEST_F(ComposeTest, ClosedShutterMeansOneMotionKey) {
  const World world = compose_frame(2, {{"camera.shutter", "[0, 0]"}});
  EXPECT_EQ(mesh_of(world, 0).motion_keys, 1);
  EXPECT_NEAR(box(mesh_of(world, 0), 0).center().x, 4, 1e-4f);
}

TEST_F(ComposeTest, FrameOffsetMovesThePoseOnly) {
  const World world =
      compose_frame(1, {{"characters.walker.frame_offset", "1"}, {"camera.shutter", "[0, 0]"}});
  EXPECT_NEAR(box(mesh_of(world, 0), 0).center().x, 4, 1e-4f);
}

TEST_F(ComposeTest, EqualCagesShareOneTopology) {
  compose_frame(1);
  EXPECT_EQ(assets_->skins.at("cube").rest->shared_topology(),
            assets_->skins.at("still").rest->shared_topology());
}

TEST_F(ComposeTest, MissingPoseIsNamed) {
  std::filesystem::remove(scene_.path("cube.0002.obj"));
  try {
    compose_frame(2);
    FAIL() << "a missing pose was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_NE(std::string(error.what()).find("cube.0002.obj"), std::string::npos);
  }
}

}  // namespace
}  // namespace pelage
