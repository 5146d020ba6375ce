// SPDX-License-Identifier: Apache-2.0
#include "world/presets.h"

#include <gtest/gtest.h>

#include "scene/document.h"
#include "scene/document_hash.h"
#include "starter/animal_preset.h"
#include "world/scene_schema.h"

namespace pelage::presets_test {
namespace {

struct Expanded {
  Value document;
  SceneDescription scene;
  std::vector<std::string> problems;
};

Expanded expanded(const std::string& yaml) {
  Expanded result{parse_document("pelage: 1\nskins: {ball: {mesh: ball.obj}}\n" + yaml, "s.yaml"), {}, {}};
  Problems problems;
  expand_presets(result.document, problems);
  if (SceneDescription::schema().read(result.document, result.scene, problems))
    check_references(result.scene, problems);
  for (const Problem& problem : problems.list())
    result.problems.push_back(to_string(problem.position) + ": " + problem.message);
  return result;
}

std::string operators_of(const Expanded& from) {
  std::string text;
  for (const auto& item : from.scene.grooms.items.front().value.operators.items) {
    text += item.name + "(";
    for (const ParameterText& p : item.prototype->parameters()) text += p.key + "=" + p.text + " ";
    text += ")";
  }
  return text;
}

TEST(Presets, OfEveryAnimalAreValidGroomsAndMaterials) {
  ASSERT_GE(animal_coats().size(), 10u);
  const std::string_view help = GroomParams::schema().find("preset")->options.help;
  for (const AnimalCoat& animal : animal_coats()) {
    const std::string name = animal.name;
    const Expanded found = expanded("grooms: {coat: {preset: " + name +
                                    ", skin: ball}}\nmaterials: {fur: {preset: " + name + "}}\n");
    EXPECT_TRUE(found.problems.empty()) << name << ": " << found.problems.front();
    EXPECT_GT(found.scene.grooms.items.front().value.density->value({}), 0) << name;
    EXPECT_TRUE(fibre_params(found.scene.materials.items.front().value)) << name;
    EXPECT_NE(help.find(name), std::string_view::npos) << name;
    EXPECT_FALSE(found.document.find("grooms")->entries().front().value.find("preset"));
  }
}

TEST(Presets, AreTheSameDocumentAsTheirKeys) {
  const AnimalCoat& rat = *find_animal_coat("rat");
  std::string keys = groom_text(rat, 0.1, 1);
  keys.insert(keys.size() - 1, ", skin: ball");
  const auto hash = [](const Expanded& of) { return document_hash(of.document); };
  const Expanded preset =
                     expanded("grooms: {coat: {preset: rat, skin: ball}}\nmaterials: {fur: {preset: rat}}\n"),
                 written =
                     expanded("grooms: {coat: " + keys + "}\nmaterials: {fur: " + material_text(rat) + "}\n");
  EXPECT_EQ(hash(preset).high, hash(written).high);
  EXPECT_EQ(hash(preset).low, hash(written).low);
}

/// A rat's hair is 14 mm long and 25 micrometres wide, 12,000 on a square centimetre.
TEST(Presets, AreScaledByUnits) {
  const Expanded centimetres = expanded("grooms: {coat: {preset: rat, skin: ball}}\n"),
                 metres =
                     expanded("units: {meters_per_unit: 1}\ngrooms: {coat: {preset: rat, skin: ball}}\n");
  EXPECT_NE(operators_of(centimetres).find("length(value=1.4 "), std::string::npos)
      << operators_of(centimetres);
  EXPECT_NE(operators_of(centimetres).find("width(root=0.0025 "), std::string::npos);
  EXPECT_NE(operators_of(metres).find("length(value=0.014 "), std::string::npos);
  EXPECT_NEAR(centimetres.scene.grooms.items.front().value.density->value({}), 12000, 1);
  EXPECT_NEAR(metres.scene.grooms.items.front().value.density->value({}), 1.2e8, 1e4);
}

TEST(Presets, LessDenseCoatsCoverAsWell) {
  // 12,000 x 1.4 cm x 25 um cover the skin 42 times: a fifth of the hairs still cover it 8 times.
  const auto root = [](const std::string& part) {
    return operators_of(
        expanded("grooms: {coat: {preset: rat, preset_density: " + part + ", skin: ball}}\n"));
  };
  EXPECT_NE(root("0.2").find("width(root=0.0025 "), std::string::npos) << root("0.2");
  EXPECT_NE(root("0.019047").find("width(root=0.025 "), std::string::npos) << root("0.019047");
}

TEST(Presets, EveryValueCanBeOverridden) {
  const Expanded found = expanded(
      "grooms:\n  coat:\n    preset: rat\n    skin: ball\n    strands: 9\n    points: 5\n    operators:\n"
      "      - comb: {direction: [1, 0, 0]}\n      - color: {value: 0.5}\n      - clump: {levels: []}\n"
      "      - curl: {turns: 3}\n      - length: {value: 2}\n      - length: {scale: 0.5}\n"
      "materials: {fur: {preset: rat, kappa: 0.3, color: 0.2}, hair: {preset: human-curly, melanin: "
      "{pheomelanin: 1}}}\n");
  EXPECT_TRUE(found.problems.empty()) << found.problems.front();
  const GroomParams& coat = found.scene.grooms.items.front().value;
  EXPECT_EQ(coat.strands, 9);
  EXPECT_FALSE(coat.density);
  EXPECT_EQ(coat.points, 5);
  const std::string text = operators_of(found);
  EXPECT_NE(text.find("length(value=2 scale=1 add=0 variation=0.35 )comb(direction=[1, 0, 0] lift=0.3 "),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("color(value=0.5 variation=0.2 )curl("), std::string::npos) << text;
  EXPECT_NE(text.find("turns=3"), std::string::npos) << text;
  EXPECT_LT(text.find("curl("), text.rfind("length(")) << text;  // the second length follows
  const auto& fur = std::get<YanFastParams>(found.scene.materials.items[0].value);
  EXPECT_EQ(fur.kappa, 0.3f);
  EXPECT_EQ(fur.color.value({}), 0.2f);
  const auto& hair = std::get<ChiangParams>(found.scene.materials.items[1].value);
  EXPECT_EQ(hair.melanin->eumelanin, 4);
  EXPECT_EQ(hair.melanin->pheomelanin, 1);
}

TEST(Presets, OtherModelsTakeTheColourOnly) {
  const Expanded found = expanded(
      "materials:\n  a: {model: cone-shell, preset: fox}\n  b: {model: yan, preset: human-red}\n"
      "  c: {model: chiang, preset: fox}\n");
  ASSERT_TRUE(found.problems.empty()) << found.problems.front();
  const auto& materials = found.scene.materials.items;
  EXPECT_EQ(ValueReader<Field>::print(std::get<ConeShellParams>(materials[0].value).color),
            "{attribute: color}");
  EXPECT_EQ(std::get<YanParams>(materials[1].value).melanin->pheomelanin, 0.6f);
  EXPECT_EQ(std::get<ChiangParams>(materials[2].value).preset, HairPreset::kFox);  // its own
}

TEST(Presets, MistakesAreOneLineWithTheNearestName) {
  EXPECT_EQ(
      expanded("grooms: {coat: {preset: polarbear, skin: ball}}\nmaterials: {fur: {preset: foxx}}\n")
          .problems,
      (std::vector<std::string>{"s.yaml:3:25: there is no preset 'polarbear'; did you mean 'polar-bear'?",
                                "s.yaml:4:27: there is no preset 'foxx'; did you mean 'fox'?"}));
  EXPECT_EQ(expanded("grooms: {coat: {preset: [rat], skin: ball}}\n").problems,
            std::vector<std::string>{"s.yaml:3:25: expected the name of a preset, got a list of 1"});
  EXPECT_EQ(expanded("grooms: {coat: {preset: rat, preset_density: 2, skin: ball}}\n").problems.size(), 1u);
  EXPECT_EQ(expanded("grooms: {coat: {preset_density: 0.5, strands: 9, skin: ball}}\n").problems,
            std::vector<std::string>{"s.yaml:3:33: `preset_density` needs `preset`"});
  EXPECT_EQ(expanded("materials: {fur: {model: cone-shell, preset: foxx}}\n").problems,
            std::vector<std::string>{"s.yaml:3:46: there is no preset 'foxx'; did you mean 'fox'?"});
}

}  // namespace
}  // namespace pelage::presets_test
