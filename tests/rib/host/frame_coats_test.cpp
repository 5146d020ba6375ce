// SPDX-License-Identifier: Apache-2.0
#include "world/frame_coats.h"

#include <gtest/gtest.h>

#include "rib/host/coat_tree.h"
#include "tests/world/furry_scene.h"

namespace pelage {
namespace {

StrandsById tree_strands(const FrameCoat& coat) {
  const CoatTree tree(coat, coat.lod);
  StrandsById strands;
  for (size_t leaf = 0; leaf < tree.all().end; ++leaf) add_strands(tree.leaf(leaf).generate(), strands);
  return strands;
}

TEST(FrameCoats, GrowTheStrandsOfThePicture) {
  const FurryScene files;
  for (const char* lod : {"false", "true"}) {
    // Far away, so that level of detail removes strands.
    const std::vector<Override> overrides{{"render.lod.enabled", lod}, {"camera.position", "[30, 20, 80]"}};
    QuietJob job;
    const SceneDescription scene = load_scene(files.scene(), overrides);
    const auto assets = load_assets(scene, job);
    const FrameParts parts = pose_frame(scene, *assets, 2, job);
    ASSERT_EQ(parts.coats.size(), 2u);
    for (const FrameCoat& coat : parts.coats) {
      const StrandsById reference =
          picture_strands(files.scene(), coat.character + "." + coat.groom, 2, overrides);
      EXPECT_FALSE(reference.empty());
      EXPECT_EQ(tree_strands(coat), reference) << coat.groom << ", lod " << lod;
    }
    EXPECT_EQ(parts.skins[0].cages.cages.size(), 3u);
    EXPECT_EQ(parts.skins[1].cages.cages.size(), 1u);
  }
}

TEST(FrameCoats, OneCharacterAlone) {
  const FurryScene files;
  QuietJob job;
  const SceneDescription scene = load_scene(files.scene());
  const auto assets = load_assets(scene, job);
  const FrameParts parts = pose_frame(scene, *assets, 1, job, {"post"});
  ASSERT_EQ(parts.coats.size(), 1u);
  EXPECT_EQ(parts.coats[0].groom, "whiskers");
  EXPECT_TRUE(pose_frame(scene, *assets, 1, job, {"nobody"}).coats.empty());
}

TEST(FrameCoats, MotionTimesCoverTheShutter) {
  CameraParams camera;
  camera.shutter = V2f(-0.25f, 0.5f);
  EXPECT_EQ(motion_times(camera, 1), std::vector<float>{-0.25f});
  EXPECT_EQ(motion_times(camera, 4), (std::vector<float>{-0.25f, 0, 0.25f, 0.5f}));
}

}  // namespace
}  // namespace pelage
