// SPDX-License-Identifier: Apache-2.0
#include "rib/document/rib_material_table.h"

#include <gtest/gtest.h>

#include "base/file.h"
#include "base/temporary_folder.h"
#include "world/scene_schema.h"

namespace pelage::rib_material_table_test {
namespace {

class RibMaterialTableTest : public testing::Test {
 protected:
  SceneDescription shot(const std::string& text, const std::string& table,
                        const std::vector<Override>& overrides = {}) const {
    write_file(folder_.path() / "shot.rib", "Projection \"perspective\" WorldBegin\n" + text + "WorldEnd");
    write_file(folder_.path() / "table.yaml", table);
    return load_scene(folder_.path() / "shot.rib", overrides, {folder_.path() / "table.yaml", nullptr});
  }
  std::string failure(const std::string& text, const std::string& table) const {
    try {
      shot(text, table);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
  TemporaryFolder folder_;
};

const std::string kHair = "Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 0 0 1 0] \"constantwidth\" 0.1\n";
const std::string kRed =
    "Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 0 0 1 0] \"constantwidth\" 0.1 \"uniform color Cs\" [1 "
    "0 0]\n";
const std::string kMesh = "PointsPolygons [3] [0 1 2] \"P\" [0 0 0 1 0 0 0 1 0]\n";

TEST_F(RibMaterialTableTest, ParametersOfShadersAreValuesOfMaterials) {
  const SceneDescription scene = shot(
      "Color [0.1 0.2 0.3] Surface \"plastic\" \"float roughness\" 0.25 \"color specularcolor\" [1 1 1]\n" +
          kMesh + "Surface \"hair\" \"float soft\" [0.7]\n" + kRed + "Surface \"other\"\n" + kHair,
      "plastic: {model: glossy, color: $Color, roughness: $roughness, ior: $ior}\n"
      "hair: {model: cone-shell, color: $Color, diffuse: $soft, opacity: 0.5}\n");
  const auto& plastic = std::get<GlossyParams>(scene.materials.find("plastic")->value);
  EXPECT_EQ(plastic.roughness, 0.25f);
  EXPECT_EQ(plastic.ior, GlossyParams().ior) << "the shader has no parameter `ior`";
  const auto& hair = std::get<ConeShellParams>(scene.materials.find("hair")->value);
  EXPECT_EQ(hair.diffuse, 0.7f);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].message.find("shader 'other' is not known"), std::string::npos);
}

TEST_F(RibMaterialTableTest, ATableNamesNoFolderToWriteInto) {
  const SceneDescription scene = shot("Surface \"hair\" \"string f\" \"/etc\"\n" + kHair,
                                      "hair: {model: yan, preset: mouse, tables: $f}\n");
  EXPECT_TRUE(std::get<YanParams>(scene.materials.find("hair")->value).tables.empty());
  EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST_F(RibMaterialTableTest, CurvesAndMeshesMayDiffer) {
  const SceneDescription scene =
      shot("Surface \"matte\"\n" + kMesh + kHair,
           "matte: {meshes: {model: lambert, color: 0.5}, curves: {model: cone-shell, color: 0.25}}\n");
  EXPECT_TRUE(std::holds_alternative<LambertParams>(scene.materials.find("matte")->value));
  EXPECT_TRUE(std::holds_alternative<ConeShellParams>(scene.materials.find("matte.2")->value));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(RibMaterialTableTest, TheTableWinsOverTheFileAndFlagsOverTheTable) {
  const std::string text =
      "Surface \"pelage_skin\" \"string name\" \"hide\" \"string pelage\" [\"{model: lambert, color: "
      "0.1}\"]\n" +
      kMesh;
  EXPECT_TRUE(std::holds_alternative<GlossyParams>(
      shot(text, "hide: {model: glossy, color: 0.5}\n").materials.find("hide")->value));
  const SceneDescription scene =
      shot(text, "hide: {model: glossy, color: 0.5}\n", {{"materials.hide", "{model: lambert, color: 1}"}});
  EXPECT_TRUE(std::holds_alternative<LambertParams>(scene.materials.find("hide")->value));
}

TEST_F(RibMaterialTableTest, UnknownNamesAreReportedOnce) {
  const std::string two = "Surface \"wood\" \"float a\" 1\n" + kMesh + "Surface \"wood\" \"float a\" 2\n" +
                          kMesh + "Surface \"stone\"\n" + kMesh;
  const SceneDescription scene = shot(two, "wod: {model: lambert}\n");
  ASSERT_EQ(scene.warnings.size(), 3u) << "wood once, stone once, and the entry that is not used";
  EXPECT_NE(scene.warnings[2].message.find("no surface has the shader 'wod'; did you mean 'wood'?"),
            std::string::npos);
  EXPECT_EQ(scene.warnings[2].position.line, 1);
}

TEST_F(RibMaterialTableTest, ATableForASceneWithoutRibIsReadAndReported) {
  write_file(folder_.path() / "table.yaml", "plastic: {model: lambert}\n");
  write_file(folder_.path() / "scene.yaml", "pelage: 1\n");
  RibUse use;
  use.materials = folder_.path() / "table.yaml";
  const SceneDescription scene = load_scene(folder_.path() / "scene.yaml", {}, use);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].message.find("no surface has the shader 'plastic'"), std::string::npos);
  use.materials = folder_.path() / "none.yaml";
  EXPECT_THROW(load_scene(folder_.path() / "scene.yaml", {}, use), Error);
}

TEST_F(RibMaterialTableTest, MistakesHavePositionsInTheTable) {
  const std::string wood = "Surface \"wood\"\n" + kMesh;
  EXPECT_NE(
      failure(wood, "wood: {model: glossy,\n  rougness: 1}\n").find("table.yaml:2:3: unknown key 'rougness'"),
      std::string::npos);
  EXPECT_NE(failure(wood, "wood: 5\n").find("table.yaml:1:7: expected a material"), std::string::npos);
  EXPECT_NE(failure(wood, "- wood\n").find("expected a table of materials"), std::string::npos);
}

}  // namespace
}  // namespace pelage::rib_material_table_test
