// SPDX-License-Identifier: Apache-2.0
#include "world/regions.h"

#include <gtest/gtest.h>

#include "scene/document.h"
#include "world/scene_schema.h"

namespace pelage::regions_test {
namespace {

std::vector<std::string> problems_of(const std::string& yaml) {
  Value document = parse_document("pelage: 1\n" + yaml, "s.yaml");
  Problems problems;
  expand_regions(document, problems);
  std::vector<std::string> lines;
  for (const Problem& problem : problems.list())
    lines.push_back(to_string(problem.position) + ": " + problem.message);
  return lines;
}

const std::string kUse =
    "grooms:\n  coat:\n    skin: cube\n    strands: 9\n    density: {region: tip}\n"
    "    operators: [{length: {value: {add: [1, {region: ears}]}, mask: {region: ears}}}]\n"
    "materials: {fur: {model: cone-shell, color: {region: ears}}}\n";

TEST(Regions, StandForTheirFieldsEverywhere) {
  Value document = parse_document(
      "pelage: 1\nregions:\n  ears: {invert: {region: tip}}\n  tip: {height: y}\n" + kUse, "s.yaml");
  Problems problems;
  expand_regions(document, problems);
  SceneDescription scene;
  SceneDescription::schema().read(document, scene, problems);
  for (const Problem& problem : problems.list()) ADD_FAILURE() << problem.message;
  const GroomParams& coat = scene.grooms.items.front().value;
  EXPECT_EQ(ValueReader<Field>::print(*coat.density), "{height: y}");
  std::string text;
  for (const ParameterText& parameter : coat.operators.items.front().prototype->parameters())
    text += parameter.key + "=" + parameter.text + " ";
  EXPECT_NE(text.find("value={add: [1, {invert: {height: y}}]}"), std::string::npos) << text;
  EXPECT_NE(text.find("mask={invert: {height: y}}"), std::string::npos) << text;
  std::visit(
      [](const auto& material) {
        EXPECT_EQ(ValueReader<Field>::print(material.color), "{invert: {height: y}}");
      },
      scene.materials.items.front().value);
}

TEST(Regions, UnknownNamesAreReportedWithTheNearest) {
  EXPECT_EQ(problems_of("regions:\n  eras: 0.5\n  tip: 1\n" + kUse),
            (std::vector<std::string>{"s.yaml:10:53: there is no region 'ears'; did you mean 'eras'?",
                                      "s.yaml:10:77: there is no region 'ears'; did you mean 'eras'?",
                                      "s.yaml:11:54: there is no region 'ears'; did you mean 'eras'?"}));
  EXPECT_EQ(problems_of("materials: {fur: {model: cone-shell, color: {region: ears}}}\n"),
            std::vector<std::string>{"s.yaml:2:54: there is no region 'ears'; the scene has none"});
}

TEST(Regions, ACircleIsReportedOnce) {
  EXPECT_EQ(
      problems_of("regions:\n  ears: {invert: {region: tip}}\n  tip: {add: [1, {region: ears}]}\n" + kUse),
      std::vector<std::string>{"s.yaml:3:27: the region 'tip' is defined by itself"});
}

TEST(Regions, CannotGrowWithoutLimit) {
  std::string many = "regions:\n  r0: {height: y}\n", deep = many;
  for (int i = 1; i <= 30; ++i) {
    const std::string last = "{region: r" + std::to_string(i - 1) + "}";
    many += "  r" + std::to_string(i) + ": {add: [" + last + ", " + last + "]}\n";
  }
  for (int i = 1; i <= 40; ++i)
    deep += "  r" + std::to_string(i) + ": {invert: {region: r" + std::to_string(i - 1) + "}}\n";
  const auto too_large = problems_of(many), too_deep = problems_of(deep);
  ASSERT_EQ(too_large.size(), 1u);
  EXPECT_NE(too_large[0].find("too large"), std::string::npos) << too_large[0];
  ASSERT_EQ(too_deep.size(), 1u);
  EXPECT_NE(too_deep[0].find("more than 32 deep"), std::string::npos) << too_deep[0];
}

}  // namespace
}  // namespace pelage::regions_test
