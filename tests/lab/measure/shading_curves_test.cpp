// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/shading_curves.h"

#include <iterator>

#include <gtest/gtest.h>

namespace pelage {
namespace {

std::vector<std::string> ids(const std::vector<ShadingCurve>& curves) {
  std::vector<std::string> ids;
  for (const ShadingCurve& curve : curves) ids.push_back(curve.id);
  return ids;
}

TEST(ShadingCurves, HaveTheNamesOfTheParts) {
  SceneDescription scene;
  scene.crowds.items.resize(1);
  EXPECT_EQ(ids(shading_curves(scene, {})),
            std::vector<std::string>(std::begin(kShadingParts), std::end(kShadingParts)));
  EXPECT_EQ(ids(shading_curves(scene, {"reuse", "gather"})),
            (std::vector<std::string>{"path", "gather", "reuse"}));
}

TEST(ShadingCurves, OmitTheCacheSettingThatGatherHasAnyway) {
  const auto which = [](int bounces, std::optional<bool> cache, size_t crowds = 0, size_t skins = 1) {
    SceneDescription scene;
    scene.render.bounces = bounces;
    scene.render.gather.cache = cache;
    scene.crowds.items.resize(crowds);
    scene.characters.items.resize(1);
    scene.characters.items[0].value.parts.resize(skins);
    std::vector<std::string> found = ids(shading_curves(scene, {"cache", "no_cache"}));
    found.erase(found.begin());  // path
    return found;
  };
  using Ids = std::vector<std::string>;
  EXPECT_EQ(which(2, {}), Ids{"cache"});
  EXPECT_EQ(which(3, {}), Ids{"no_cache"});
  EXPECT_EQ(which(3, {}, 1), (Ids{"cache", "no_cache"})) << "a crowd may be small";
  EXPECT_EQ(which(3, {}, 0, 9), (Ids{"cache", "no_cache"})) << "not all of them may be drawn";
  EXPECT_EQ(which(2, {}, 1), Ids{"cache"});
  EXPECT_EQ(which(8, {}, 1), Ids{"no_cache"});
  EXPECT_EQ(which(4, true, 1), Ids{"no_cache"});
  EXPECT_EQ(which(8, false), Ids{"cache"});
}

TEST(ShadingCurves, ChangeOneSettingOfTheScene) {
  SceneDescription scene;
  scene.render.gather.spacing = 1.5f;
  const std::vector<ShadingCurve> curves = shading_curves(scene, {"gather", "spacing"});
  ASSERT_EQ(curves.size(), 3u);
  EXPECT_EQ(curves[2].title, "gather, spacing: 3");
  EXPECT_EQ(curves[2].settings.back(), std::pair(std::string("render.gather.spacing"), std::string("3")));
  EXPECT_EQ(curves[2].settings.size(), curves[1].settings.size() + 1);
  EXPECT_TRUE(curves[2].gather);
  EXPECT_FALSE(curves[0].gather);
}

TEST(ShadingCurves, AllButDualFollowPathsWhateverTheSceneSays) {
  std::vector<ShadingCurve> curves = shading_curves({}, {});
  curves.push_back(reference_curve());
  for (const ShadingCurve& curve : curves) {
    std::vector<std::string> values;
    for (const auto& [key, value] : curve.settings) {
      if (key == "render.indirect") values.push_back(value);
    }
    EXPECT_EQ(values, std::vector<std::string>{curve.id == "dual" ? "dual" : "path"}) << curve.id;
  }
}

TEST(ShadingCurves, SwitchWhatTheSceneDoesNot) {
  SceneDescription scene;
  const std::vector<ShadingCurve> off = shading_curves(scene, {"screen_door"});
  ASSERT_EQ(off.size(), 2u);
  EXPECT_EQ(off[1].title, "path, screen_door: true");
  EXPECT_EQ(off[1].settings.back(), std::pair(std::string("render.screen_door"), std::string("true")));
  EXPECT_FALSE(off[1].gather);
  scene.render.screen_door = true;
  const std::vector<ShadingCurve> on = shading_curves(scene, {"gather_screen_door"});
  ASSERT_EQ(on.size(), 2u);
  EXPECT_EQ(on[1].title, "gather, screen_door: false");
  EXPECT_TRUE(on[1].gather);
}

TEST(ShadingCurves, SwitchEverythingAboutOcclusionOnTogether) {
  const std::vector<ShadingCurve> curves = shading_curves({}, {"together", "gather_together"});
  ASSERT_EQ(curves.size(), 3u);
  for (size_t i : {1, 2}) {
    using Settings = std::vector<std::pair<std::string, std::string>>;
    EXPECT_EQ(Settings(curves[i].settings.end() - 2, curves[i].settings.end()),
              (Settings{{"render.skin_ball", "exact"}, {"render.screen_door", "true"}}));
    EXPECT_EQ(curves[i].gather, i == 2);
  }
}

}  // namespace
}  // namespace pelage
