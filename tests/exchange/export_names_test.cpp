// SPDX-License-Identifier: Apache-2.0
#include <regex>
#include <set>

#include <gtest/gtest.h>

#include "base/file.h"
#include "exchange/scene_export.h"
#include "geom/usd/usd_validation.h"
#include "tests/world/furry_scene.h"

namespace pelage::export_names_test {
namespace {

void replace_all(std::string& text, const std::string& before, const std::string& after) {
  for (size_t at = 0; (at = text.find(before, at)) != std::string::npos; at += after.size())
    text.replace(at, before.size(), after);
}

/// A scene whose names are valid in YAML only, or equal in USD, or those of prims that the export adds.
class ExportNames : public testing::Test {
 protected:
  std::string exported(ExportFormat format, const std::string& file, const std::string& hide,
                       const std::vector<Override>& overrides = {}) {
    std::string scene = read_file(files_.scene());
    replace_all(scene, "hide", hide);
    replace_all(scene, "  fur:", "  a_b:");
    replace_all(scene, ": fur}", ": a_b}");
    replace_all(scene, "  walker:", "  lights:");
    replace_all(scene, "  post:", "  camera:");
    replace_all(scene, "{attribute: color}", "0.5");
    replace_all(scene, "  sky: {type: environment", "  sky: {type: environment, visible: false");
    write_file(files_.path("fur.yaml"), scene);
    QuietJob job;
    const SceneDescription described = load_scene(files_.scene(), overrides);
    const auto assets = load_assets(described, job);
    folder_ = files_.path("out");
    export_scene(folder_, format, {files_.scene(), described, *assets}, job);
    return read_file(folder_ / file);
  }
  static size_t count(const std::string& text, const std::string& part) {
    size_t found = 0;
    for (size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++found;
    return found;
  }
  const FurryScene files_;
  std::filesystem::path folder_;
};

TEST_F(ExportNames, OfUsdAreUniqueAmongPrims) {
  const std::string stage =
      exported(ExportFormat::kUsd, "fur.usda", "a-b", {{"units.meters_per_unit", "0.5"}});
  EXPECT_EQ(validate_usd(folder_ / "fur.usda").problems, std::vector<std::string>());
  EXPECT_EQ(count(stage, "def Scope \"lights\""), 1u);
  EXPECT_EQ(count(stage, "def Xform \"lights_2\""), 1u);
  EXPECT_EQ(count(stage, "def Camera \"camera\""), 1u);
  EXPECT_EQ(count(stage, "def Xform \"camera_2\""), 1u);
  EXPECT_EQ(count(stage, "def Material \"a_b\""), 1u);
  EXPECT_EQ(count(stage, "def Material \"a_b_2\""), 1u);
  EXPECT_EQ(count(stage, "</scene/materials/a_b>"), 2u);
  EXPECT_EQ(count(stage, "</scene/materials/a_b_2>"), 2u);
  EXPECT_NE(stage.find("float2 clippingRange = (0.002, 20000)"), std::string::npos) << "1 mm to 10 km";
  EXPECT_NE(read_file(folder_ / "README.md").find("the camera sees it"), std::string::npos);
}

TEST_F(ExportNames, OfPbrtNeedNoEscapes) {
  const std::string text = exported(ExportFormat::kPbrt, "fur.pbrt", "'qu\"o\\te'");
  EXPECT_EQ(count(text, "MakeNamedMaterial \"qu_o_te\""), 1u);
  EXPECT_EQ(count(text, "\nNamedMaterial \"qu_o_te\"\n"), 2u);
}

TEST_F(ExportNames, OfTwinMaterialsAvoidThoseOfTheScene) {
  const std::string text =
      exported(ExportFormat::kMitsuba, "fur.xml", "a_b_2",
               {{"materials.a_b.color", "{ramp: {along: y, knots: [[0, 0.1], [1, 0.5]]}}"}});
  EXPECT_EQ(count(text, "id=\"a_b_2\">\n"), 1u);
  EXPECT_EQ(count(text, "id=\"a_b_3\">\n"), 1u);
}

}  // namespace
}  // namespace pelage::export_names_test
