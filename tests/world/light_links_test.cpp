// SPDX-License-Identifier: Apache-2.0
#include "world/light_links.h"

#include <fstream>

#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "render/light/sphere_light.h"
#include "world/scene_schema.h"

namespace pelage::light_links_test {
namespace {

std::string mistakes(const std::string& light) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "s.yaml")
      << "pelage: 1\nskins: {rat: {mesh: rat.obj}}\ngrooms: {under: {skin: rat, strands: 10}}\n"
         "materials: {hide: {model: lambert}, fur: {model: cone-shell}}\n"
         "characters: {mouse: {parts: [{skin: rat, material: hide, grooms: {under: fur}}]}}\n"
         "crowds: {colony: {of: [mouse], count: 3, area: {type: disc, radius: 1}}}\nlights:\n  key: " +
             light + "\n";
  try {
    load_scene(folder.path() / "s.yaml", {});
  } catch (const Error& error) {
    std::string text;
    for (const Problem& problem : error.problems()) {
      text += std::to_string(problem.position.line) + ":" + std::to_string(problem.position.column) + ": " +
              problem.message + "\n";
    }
    return text;
  }
  return "";
}

TEST(LightLinks, UnknownNamesAreOneLineEach) {
  EXPECT_EQ(mistakes("{type: point, illuminates: [mouse, mouse.under, mouse.rat, colony], shadowed_by: []}"),
            "");
  EXPECT_EQ(mistakes("{type: point, illuminates: [mouse.undre]}"),
            "8:36: there is no character, crowd, archive, coat or skin 'mouse.undre'; did you mean "
            "'mouse.under'?\n");
  EXPECT_EQ(mistakes("{type: sun, shadowed_by: [moose]}"),
            "8:34: there is no character, crowd, archive, coat or skin 'moose'; did you mean 'mouse'?\n");
  EXPECT_EQ(mistakes("{type: sun, shadows: false, shadowed_by: [mouse]}"),
            "8:3: light 'key' has `shadows: false`, so `shadowed_by` has no effect; remove one\n");
}

TEST(LightLinks, NamesIncludeWhatBelongsToThem) {
  std::vector<FurPart> fur(3);
  fur[0].name = fur[0].prototype = "mouse.under";
  fur[1].name = "colony.17.under";
  fur[1].prototype = "mouse.under";
  fur[2].name = fur[2].prototype = "mouse2.under";
  std::vector<SkinPart> skins(1);
  skins[0].name = skins[0].prototype = "mouse.rat";
  const auto lit = [&](const std::vector<std::string>& names) {
    PointLightParams params;
    params.illuminates.emplace();
    for (const std::string& name : names) params.illuminates->push_back({name, {}});
    SphereLight light("key", V3f(0), 1, Rgb(1), false);
    link_light(params, fur, skins, light);
    std::string text;
    for (uint32_t i = 0; i < fur.size(); ++i) text += light.illuminates({false, i}) ? '1' : '0';
    return text + (light.illuminates({true, 0}) ? "1" : "0");
  };
  EXPECT_EQ(lit({"mouse"}), "1101");
  EXPECT_EQ(lit({"mouse.under"}), "1100");
  EXPECT_EQ(lit({"colony"}), "0100");
  EXPECT_EQ(lit({"mouse2", "mouse.rat"}), "0011");
  EXPECT_EQ(lit({}), "0000");
}

}  // namespace
}  // namespace pelage::light_links_test
