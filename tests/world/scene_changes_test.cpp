// SPDX-License-Identifier: Apache-2.0
#include "world/scene_changes.h"

#include <gtest/gtest.h>

#include "tests/world/small_scene.h"
#include "world/scene_schema.h"

namespace pelage {
namespace {

class SceneChanges : public testing::Test {
 protected:
  Redo redo(const std::vector<Override>& before, const std::vector<Override>& after) const {
    const std::string path = scene_.path("scene.yaml");
    return compare_scenes(load_scene(path, before).parts, load_scene(path, after).parts);
  }
  Redo redo_after(const std::string& key, const std::string& value) const { return redo({}, {{key, value}}); }
  SmallScene scene_;
};

TEST_F(SceneChanges, LightsMaterialsAndSamplesKeepGeometry) {
  EXPECT_EQ(redo({}, {}), Redo::kNothing);
  for (const auto& [key, value] :
       std::vector<std::pair<std::string, std::string>>{{"lights.key.intensity", "31"},
                                                        {"lights.extra", "{type: environment, radiance: 1}"},
                                                        {"materials.fur.color", "[0.5, 0.4, 0.2]"},
                                                        {"materials.fur.diffuse", "0.2"},
                                                        {"materials.hide.color", "0.1"},
                                                        {"render.samples", "9"},
                                                        {"render.bounces", "0"},
                                                        {"render.integrator", "gather"},
                                                        {"render.gather.spacing", "2"},
                                                        {"render.gather.reuse", "false"},
                                                        {"image.light_layers", "false"}})
    EXPECT_EQ(redo_after(key, value), Redo::kSampling) << key;
}

TEST_F(SceneChanges, TheCameraAndTheFrameKeepAssets) {
  EXPECT_EQ(redo_after("camera.position", "[3, 2, 9]"), Redo::kGeometry);
  EXPECT_EQ(redo_after("camera.lens", "{f_stop: 4}"), Redo::kGeometry);
  EXPECT_EQ(redo_after("frames", "2"), Redo::kGeometry);
}

TEST_F(SceneChanges, WidthsOfDrawnStrandsKeepAssets) {
  const std::vector<Override> gather{{"render.integrator", "gather"}};
  for (const auto& [key, value] : std::vector<std::pair<std::string, std::string>>{
           {"render.gather.min_width", "0.5"}, {"render.gather.visibility", "rays"}}) {
    EXPECT_EQ(redo(gather, {gather[0], {key, value}}), Redo::kGeometry) << key;
  }
}

TEST_F(SceneChanges, EverythingElseStartsAnew) {
  for (const auto& [key, value] :
       std::vector<std::pair<std::string, std::string>>{{"grooms.coat.strands", "500"},
                                                        {"grooms.coat.operators.length.value", "0.5"},
                                                        {"characters.walker.transform.scale", "1"},
                                                        {"skins.still.scheme", "none"},
                                                        {"materials.fur.opacity", "0.5"},
                                                        {"materials.fur.color", "{attribute: color}"},
                                                        {"materials.fur", "{model: kajiya-kay}"},
                                                        {"render.memory", "1G"},
                                                        {"render.lod.enabled", "true"},
                                                        {"render.bounds", "none"},
                                                        {"image.width", "32"}})
    EXPECT_EQ(redo_after(key, value), Redo::kAssets) << key;
}

TEST_F(SceneChanges, TheOrderOfMaterialsCounts) {
  const std::vector<Override> ab{{"materials.a", "{model: kajiya-kay}"},
                                 {"materials.b", "{model: kajiya-kay}"}};
  EXPECT_EQ(redo(ab, {ab[1], ab[0]}), Redo::kAssets);
}

TEST_F(SceneChanges, WhatIsRemovedCountsToo) {
  EXPECT_EQ(redo({{"render.light_samples", "2"}}, {}), Redo::kSampling);
  EXPECT_EQ(redo({{"materials.fur.opacity", "0.5"}}, {}), Redo::kAssets);
  EXPECT_EQ(redo({{"render.light_samples", "2"}, {"grooms.coat.seed", "3"}}, {}), Redo::kAssets);
}

}  // namespace
}  // namespace pelage
