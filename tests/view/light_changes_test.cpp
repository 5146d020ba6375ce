// SPDX-License-Identifier: Apache-2.0
#include "view/light_changes.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/world/small_scene.h"
#include "world/scene_schema.h"

namespace pelage {
namespace {

using Numbers = std::vector<double>;

/// The values of a light `lamp` that `view` shows.
std::map<std::string, Numbers> shown(const std::string& lamp) {
  const SmallScene files;
  files.write("lamp.ies", "IESNA:LM-63-1995\nTILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n1 1 50\n0 90 0 100 0\n");
  const SceneDescription scene =
      load_scene(files.path("scene.yaml"), {{.key = "lights.lamp", .value = lamp}});
  for (const ViewLight& light : view_lights(scene, 1, {}))
    if (light.item.name == "lamp") return light.values;
  return {};
}

TEST(LightChanges, ProfilesOfPointsHaveAnAim) {
  EXPECT_EQ(shown("{type: point, position: [1, 5, 0], look_at: [1, 2, 3], profile: lamp.ies}").at("look_at"),
            Numbers({1, 2, 3}));
  // Straight down, where the scene does not say.
  EXPECT_EQ(shown("{type: point, position: [1, 5, 0], radius: 0.125, profile: lamp.ies}").at("look_at"),
            Numbers({1, 2.5, 0}));
  EXPECT_EQ(shown("{type: point, position: [1, 5, 0]}").count("look_at"), 0u);
  EXPECT_EQ(shown("{type: spot, position: [1, 5, 0], look_at: [0, 0, 2]}").at("look_at"), Numbers({0, 0, 2}));
}

TEST(LightChanges, EveryShownValueButUpCanBeChanged) {
  for (const char* lamp : {"{type: point, profile: lamp.ies}", "{type: spot}", "{type: disk}",
                           "{type: rectangle}", "{type: sphere}", "{type: sun}"}) {
    const std::string text = lamp, type = text.substr(7, text.find_first_of(",}") - 7);
    const std::vector<LightKey>& keys = light_keys(type);
    for (const auto& [key, numbers] : shown(text)) {
      if (key == "up") continue;
      const auto found =
          std::find_if(keys.begin(), keys.end(), [&](const LightKey& k) { return k.name == key; });
      ASSERT_NE(found, keys.end()) << type << ' ' << key;
      EXPECT_EQ(found->numbers, numbers.size()) << type << ' ' << key;
    }
  }
}

}  // namespace
}  // namespace pelage
