// SPDX-License-Identifier: Apache-2.0
#include "rib/document/rib_frames.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "base/file.h"
#include "base/temporary_folder.h"
#include "tests/support/quiet_job.h"
#include "world/world.h"

namespace pelage::rib_frames_test {
namespace {

TEST(RibFrames, HaveTheirOwnMaterials) {
  const TemporaryFolder folder;
  const auto frame = [](int number, const std::string& content) {
    return "FrameBegin " + std::to_string(number) + " Projection \"perspective\" Scale 1 1 -1 WorldBegin " +
           content + "WorldEnd FrameEnd\n";
  };
  const std::string mesh = "PointsPolygons [3] [0 1 2] \"P\" [0 0 0 1 0 0 0 1 0]\n",
                    sun = "LightSource \"sun\" 1 ";
  const std::string text =
      "FrameBegin 1 Display \"x\" \"shadow\" \"z\" WorldBegin Surface \"null\" " + mesh +
      "WorldEnd FrameEnd\n" + frame(2, sun + "Surface \"matte\" Color .1 .1 .1 " + mesh) +
      frame(3, sun + "Surface \"matte\" Color .3 .3 .3 " + mesh + "Color 1 1 1 Surface \"metal\" " + mesh) +
      frame(4, "LightSource \"sky\" 1 Surface \"matte\" Color .1 .1 .1 " + mesh);
  write_file(folder.path() / "shot.rib", text);
  const SceneDescription scene = load_scene(folder.path() / "shot.rib");
  EXPECT_EQ(scene.frames.frames, (std::vector<int>{2, 3, 4}));
  EXPECT_EQ(scene.materials.items.size(), 3u) << "null is of no picture";
  ASSERT_EQ(scene.lights.items.size(), 1u);
  const std::string other = "frame 4 has other lights than frame 2, whose lights shine in all frames";
  const auto is_other = [&](const Problem& warning) { return warning.message == other; };
  EXPECT_EQ(std::count_if(scene.warnings.begin(), scene.warnings.end(), is_other), 1);
  QuietJob quiet;
  const auto assets = load_assets(scene, quiet);
  const auto colors = [&](int number) {
    std::vector<float> all;
    const World world = compose(scene, *assets, number, quiet);
    for (const SkinPart& skin : world.scene.skins)
      all.push_back(std::get<LambertParams>(world.scene.materials[skin.material]).color.color({}).x);
    return all;
  };
  EXPECT_EQ(colors(2), (std::vector<float>{.1f}));
  EXPECT_EQ(colors(3), (std::vector<float>{.3f, 1}));
  EXPECT_EQ(colors(4), (std::vector<float>{.1f}));
  try {
    compose(scene, *assets, 1, quiet);
    ADD_FAILURE() << "a shadow map as a picture";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("frame 1 only draws shadow maps"), std::string::npos);
  }

  // The same file as an archive; what the scene says of a surface holds in all frames.
  write_file(folder.path() / "scene.yaml",
             "pelage: 1\ncamera: {position: [0, 0, 5], look_at: [0, 0, 0]}\n"
             "archives: {a: {rib: shot.rib}, b: {rib: shot.rib, materials: {matte: own}}}\n"
             "materials: {own: {model: lambert, color: 0.9}}\n");
  const SceneDescription outer = load_scene(folder.path() / "scene.yaml");
  EXPECT_TRUE(outer.materials.find("a.matte@3"));
  EXPECT_FALSE(outer.materials.find("b.matte@3"));
  EXPECT_TRUE(outer.materials.find("b.metal"));
  EXPECT_TRUE(std::none_of(outer.warnings.begin(), outer.warnings.end(), is_other))
      << "the lights of an archive shine nowhere";
}

}  // namespace
}  // namespace pelage::rib_frames_test
