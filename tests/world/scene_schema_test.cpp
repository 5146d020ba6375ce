// SPDX-License-Identifier: Apache-2.0
#include "world/scene_schema.h"

#include <fstream>

#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "render/scene/gather_params.h"

namespace pelage {
namespace {

constexpr const char* kScene =
    "pelage: 1\n"
    "frames: 1-4\n"
    "skins:\n"
    "  rat: {mesh: rat.obj, poses: {files: \"walk.%04d.obj\", count: 12}}\n"
    "  eyes: {mesh: eyes.obj}\n"
    "grooms:\n"
    "  under: {skin: rat, strands: 1000, operators: [{length: {value: 1}}, {clump: {spacing: 1}}]}\n"
    "  loose: {strands_file: a.hair}\n"
    "materials:\n"
    "  hide: {model: lambert}\n"
    "  fur: {model: cone-shell}\n"
    "characters:\n"
    "  rat:\n"
    "    parts:\n"
    "      - {skin: rat, material: hide, grooms: {under: fur, loose: fur}}\n"
    "      - {skin: eyes, material: hide}\n"
    "    transform: {translate: {keys: {1: [0, 0, 0], 3: [2, 0, 0]}}}\n"
    "lights:\n"
    "  key: {type: sphere, radius: 2}\n";

class SceneSchema : public testing::Test {
 protected:
  std::string replaced(const std::string& from, const std::string& to) const {
    std::string text = kScene;
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }
  SceneDescription load(const std::string& text, const std::vector<Override>& overrides = {}) {
    std::ofstream(folder_.path() / "s.yaml") << text;
    return load_scene(folder_.path() / "s.yaml", overrides);
  }
  std::vector<std::string> problems(const std::string& text, const std::vector<Override>& overrides = {}) {
    std::vector<std::string> lines;
    try {
      load(text, overrides);
    } catch (const Error& error) {
      for (Problem problem : error.problems()) {
        if (problem.position.line > 0) problem.position.file = "s";
        lines.push_back(to_string(problem.position) + ": " + problem.message);
      }
    }
    return lines;
  }
  using Lines = std::vector<std::string>;
  Lines warnings(const std::string& text, const std::vector<Override>& overrides = {}) {
    Lines lines;
    for (Problem warning : load(text, overrides).warnings) {
      if (warning.position.line > 0) warning.position.file = "s";
      lines.push_back(to_string(warning.position) + ": " + warning.message);
    }
    return lines;
  }

  TemporaryFolder folder_;
};

TEST_F(SceneSchema, OldNamesOfKeysMeanWhatTheyMeant) {
  const std::string lights = "lights:\n";
  const auto with = [&](const std::string& text) { return replaced(lights, text + lights); };
  const std::string old_text = with("render: {lod: {turned_away: false, least_share: 0.25}}\n");
  const SceneDescription before = load(old_text);
  const SceneDescription now = load(with("render: {lod: {backfacing: false, min_fraction: 0.25}}\n"));
  EXPECT_FALSE(before.render.lod.back_facing);
  EXPECT_EQ(before.render.lod.min_share, 0.25f);
  EXPECT_EQ(before.hash, now.hash);
  EXPECT_TRUE(now.warnings.empty());
  const Lines lines = warnings(old_text);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_TRUE(lines[0].ends_with(":16: 'turned_away' is now called 'backfacing'")) << lines[0];
  EXPECT_EQ(warnings(kScene, {{"render.lod.turned_away", "false"}}),
            Lines{"--set render.lod.turned_away: 'turned_away' is now called 'backfacing'"});
  const Lines both = problems(with("render: {lod: {turned_away: true, backfacing: false}}\n"));
  ASSERT_EQ(both.size(), 1u);
  EXPECT_TRUE(both[0].ends_with("'turned_away' is the old name of 'backfacing'; give only one of them"))
      << both[0];
}

TEST_F(SceneSchema, RemovedKeysAreReadWhereTheyChangeNothing) {
  const std::vector<Override> harmless{{"render.learned_visibility", "false"},
                                       {"render.bounds_factor", "1"},
                                       {"render.shared_topology", "true"},
                                       {"render.lod.full_detail_characters", "0"},
                                       {"render.adaptive", "{rule: two-stage}"}};
  EXPECT_TRUE(load(kScene, harmless).render.adaptive);
  EXPECT_EQ(warnings(kScene, harmless), Lines{});
  for (const auto& [key, value] : {std::pair{"render.learned_visibility", "true"},
                                   {"render.skin_ball", "fractional"},
                                   {"render.bounds", "user"},
                                   {"render.bounds_factor", "0.9"},
                                   {"render.shared_topology", "false"},
                                   {"render.lod.in_full", "2"},
                                   {"render.adaptive.rule", "seed"},
                                   {"render.adaptive.batch", "16"}}) {
    const Lines lines = problems(kScene, {{key, value}});
    ASSERT_EQ(lines.size(), 1u) << key;
    EXPECT_NE(lines[0].find("was removed: "), std::string::npos) << lines[0];
  }
}

TEST_F(SceneSchema, OldNamesOfOperatorKeys) {
  const SceneDescription scene =
      load(replaced("[{length", "[{noise: {along: 2}}, {curl: {random: 0.5}}, {length"),
           {{"grooms.under.operators.noise.along", "3"}});
  EXPECT_EQ(scene.warnings.size(), 3u);
}

TEST_F(SceneSchema, ReadsAScene) {
  const SceneDescription scene = load(kScene);
  EXPECT_EQ(scene.frames.frames, (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(scene.units.fps, 24.0f);
  EXPECT_EQ(scene.skins.names(), (std::vector<std::string>{"rat", "eyes"}));
  EXPECT_EQ(scene.skins.items[0].value.mesh.path, folder_.path() / "rat.obj");
  EXPECT_EQ(scene.skins.items[0].value.poses->files.path, folder_.path() / "walk.%04d.obj");
  EXPECT_EQ(scene.grooms.find("under")->value.strands, 1000);
  EXPECT_EQ(scene.grooms.find("under")->value.operators.items.size(), 2u);
  const CharacterParams& rat = scene.characters.find("rat")->value;
  ASSERT_EQ(rat.parts.size(), 2u);
  EXPECT_EQ(rat.parts[0].grooms.find("under")->value.name, "fur");
  EXPECT_EQ(rat.transform.translate.at(2), V3f(1, 0, 0));
  EXPECT_EQ(std::get<SphereLightParams>(scene.lights.find("key")->value).radius, 2.0f);
}

TEST_F(SceneSchema, OverridesWin) {
  const SceneDescription scene = load(kScene, {{"render.samples", "7"},
                                               {"grooms.under.strands", "5"},
                                               {"frames", "'2'"},
                                               {"lights.key", "{type: environment}"}});
  EXPECT_EQ(scene.render.samples, 7);
  EXPECT_EQ(scene.grooms.find("under")->value.strands, 5);
  EXPECT_EQ(scene.frames.frames, std::vector<int>{2});
  EXPECT_TRUE(std::holds_alternative<EnvironmentLightParams>(scene.lights.find("key")->value));
  EXPECT_EQ(problems(kScene, {{"render.sampels", "7"}}),
            Lines{"--set render.sampels: unknown key 'sampels' in render; did you mean 'samples'?"});
}

TEST_F(SceneSchema, EventLayersNeedLightLayers) {
  const std::string scene = kScene, message = ": `event_layers` needs `light_layers: true`";
  EXPECT_FALSE(load(kScene).image.event_layers);
  EXPECT_TRUE(load(scene + "image: {event_layers: true}\n").image.event_layers);
  EXPECT_EQ(problems(scene + "image: {light_layers: false, event_layers: true}\n"),
            Lines{"s:20:44" + message});
  EXPECT_EQ(problems(scene + "image: {light_layers: false}\n", {{"image.event_layers", "true"}}),
            Lines{"--set image.event_layers" + message});
}

TEST_F(SceneSchema, SettingsOfGather) {
  const Override gather{"render.integrator", "gather"}, path{"render.integrator", "path"};
  EXPECT_EQ(load(kScene).render.integrator, Integrator::kGather);
  EXPECT_EQ(load(kScene, {gather}).image.filter_samples, std::nullopt);
  const GatherParams params = load(kScene, {gather, {"render.gather", "{spacing: 2}"}}).render.gather;
  EXPECT_EQ(params.spacing, 2);
  EXPECT_TRUE(params.reuse);
  const Override raster{"render.gather", "{visibility: raster}"};
  EXPECT_EQ(load(kScene, {gather, raster}).render.gather.visibility, GatherVisibility::kRaster);
  for (const Override& other : {Override{"render.curves", "round"}, Override{"render.accel", "embree"}}) {
    EXPECT_EQ(problems(kScene, {gather, raster, other}),
              Lines{"--set render.gather: `visibility: raster` needs `accel: fur` and `curves: flat`"});
  }
  EXPECT_EQ(problems(kScene, {gather, {"render.gather", "{min_width: 1, visibility: rays}"}}),
            Lines{"--set render.gather: `min_width` needs `visibility: raster`"});
  EXPECT_EQ(problems(kScene, {gather, {"render.gather", "{cache: true, reuse: false}"}}),
            Lines{"--set render.gather: `cache: true` needs `reuse: true`"});
  const Override dual{"render.indirect", "dual"};
  EXPECT_EQ(problems(kScene, {gather, dual}),
            Lines{"--set render.indirect: `indirect: dual` needs `integrator: path`"});
  EXPECT_EQ(load(kScene, {path, dual}).render.path_bounces(), 0);
  EXPECT_FALSE(load(kScene, {gather, {"render.gather", "{cache: false, reuse: false}"}}).render.gather.reuse);
  EXPECT_TRUE(load(kScene, {gather, raster}).warnings.empty());
  const std::vector<Problem> warnings = load(kScene, {path, raster}).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].message, "`visibility: raster` has no effect without `integrator: gather`");
  // Without a request, curves that cannot be drawn are traced.
  EXPECT_TRUE(load(kScene, {gather}).render.draws_visible());
  const SceneDescription round = load(kScene, {gather, {"render.curves", "round"}});
  EXPECT_FALSE(round.render.draws_visible());
  EXPECT_TRUE(round.warnings.empty());
  EXPECT_EQ(problems(kScene, {gather, {"render.gather.spacng", "2"}}),
            Lines{"--set render.gather.spacng: unknown key 'spacng' in gather; did you mean 'spacing'?"});
}

TEST_F(SceneSchema, UnknownNamesAreReported) {
  EXPECT_EQ(problems(replaced("{skin: rat, material: hide", "{skin: ratt, material: hied")),
            (Lines{"s:15:16: there is no skin 'ratt'; did you mean 'rat'?",
                   "s:15:32: there is no material 'hied'; did you mean 'hide'?",
                   "s:15:47: groom 'under' grows on the skin 'rat', not on 'ratt'"}));
  EXPECT_EQ(problems(replaced("{under: fur, loose: fur}", "{undr: fur, loose: furr}")),
            (Lines{"s:15:46: there is no groom 'undr'; did you mean 'under'?",
                   "s:15:64: there is no material 'furr'; did you mean 'fur'?"}));
  EXPECT_EQ(problems(replaced("under: {skin: rat", "under: {skin: cat")),
            (Lines{"s:7:17: there is no skin 'cat'; did you mean 'rat'?",
                   "s:15:46: groom 'under' grows on the skin 'cat', not on 'rat'"}));
  EXPECT_EQ(problems(replaced("{strands_file: a.hair}", "{strands: 5}")),
            Lines{"s:8:3: groom 'loose' needs a skin to grow on, or a strands_file"});
}

TEST_F(SceneSchema, GroomsSayOnceHowManyStrandsTheyHave) {
  EXPECT_EQ(problems(replaced("strands: 1000, ", "")),
            Lines{"s:7:3: groom 'under' needs `strands` (how many) or `density` (how many per square unit)"});
  EXPECT_EQ(
      problems(replaced("{strands_file: a.hair}", "{strands_file: a.hair, density: 5}")),
      Lines{"s:8:3: groom 'loose' takes its strands from a file; `strands` and `density` must not be given"});
}

TEST_F(SceneSchema, NamesThatLayersOfAPictureCannotHoldAreRefused) {
  const auto named = [&](const std::string& name) {
    return problems(replaced("  key: {type", "  " + name + ": {type"));
  };
  const std::string longest(231, 'a');
  EXPECT_EQ(named(longest), Lines{});
  EXPECT_EQ(named(longest + "b"), Lines{"s:19:3: the name of light '" + longest.substr(0, 40) +
                                        "...' has 232 bytes; the limit is 231"});
  EXPECT_EQ(named("\"key\\0a\""), Lines{"s:19:3: the name of light 'key?a' contains a control character"});
  EXPECT_EQ(problems(replaced("  loose: {", "  \"lo\\0se\": {")).front(),
            "s:8:3: the name of groom 'lo?se' contains a control character");
}

TEST_F(SceneSchema, KnowsTheFilesThatItIsReadFrom) {
  std::ofstream(folder_.path() / "lights.yaml") << "lights: {fill: {type: sphere}}\n";
  const SceneDescription scene =
      load("include: lights.yaml\n" + std::string(kScene), {{"render.samples", "3"}});
  std::vector<std::filesystem::path> files;
  for (const char* name : {"s.yaml", "lights.yaml", "rat.obj", "eyes.obj", "a.hair"})
    files.push_back(folder_.path() / name);
  EXPECT_EQ(scene.files, files);
}

TEST_F(SceneSchema, MaterialsMustFitWhatTheyAreOn) {
  EXPECT_EQ(problems(replaced("material: hide, grooms: {under: fur", "material: fur, grooms: {under: hide")),
            (Lines{"s:15:31: 'fur' is a material for strands, not for skins",
                   "s:15:52: 'hide' is a material for skins, not for strands"}));
}

TEST_F(SceneSchema, GroomsGrowOnTheirOwnSkin) {
  EXPECT_EQ(problems(replaced("- {skin: eyes, material: hide}",
                              "- {skin: eyes, material: hide, grooms: {under: fur}}")),
            Lines{"s:16:47: groom 'under' grows on the skin 'rat', not on 'eyes'"});
}

TEST_F(SceneSchema, MistakesOfAllKindsComeInFileOrder) {
  const std::string text =
      "pelage: 2\n"
      "camra: {}\n"
      "camera: {fov: 400, fov: 30}\n"
      "crowds: {colony: {cout: 10, area: {type: disk}, of: [rat]}}\n"
      "lights:\n"
      "  key: {radius: 1}\n"
      "image: {width: 0}\n";
  EXPECT_EQ(problems(text),
            (Lines{"s:1:9: this program reads scenes of format 1, got '2'",
                   "s:2:1: unknown key 'camra' in scene; did you mean 'camera'?",
                   "s:3:15: expected a number 0.01 .. 170, got 400",
                   "s:3:20: duplicate key 'fov', first on line 3", "s:4:18: crowd needs the key 'count'",
                   "s:4:19: unknown key 'cout' in crowd; did you mean 'count'?",
                   "s:4:42: expected rectangle | disc | polygon, got 'disk'; did you mean 'disc'?",
                   "s:6:8: the block needs the key 'type': rectangle | disk | sphere | point | spot | sun | "
                   "mesh | environment",
                   "s:7:16: expected a whole number 1 .. 65536, got 0"}));
  EXPECT_EQ(problems("frames: 1\n"), Lines{"s:1:1: scene needs the key 'pelage'"});
}

TEST_F(SceneSchema, CrowdsAreChecked) {
  const std::string area = ", count: 3, area: {type: disc, radius: 9}";
  const auto with = [&](const std::string& crowd) {
    return std::string(kScene) + "crowds:\n  herd: {" + crowd + "}\n";
  };
  EXPECT_EQ(problems(with("of: [rat], spacing: 1" + area)), Lines{});
  EXPECT_EQ(problems(with("of: [rta]" + area)),
            Lines{"s:21:15: there is no character 'rta'; did you mean 'rat'?"});
  EXPECT_EQ(problems(with("of: []" + area)), Lines{"s:21:3: crowd 'herd' names no character"});
  EXPECT_EQ(problems(with("of: [rat], count: 3, area: {type: polygon, points: [[0, 0], [1, 1]]}")),
            Lines{"s:21:3: crowd 'herd': its area needs at least three points"});
  EXPECT_EQ(problems(with("of: [rat]" + area), {{"characters.rat.footprint", "[[0, 0, -1]]"}}),
            Lines{"s:13:3: character 'rat': a disc [x, z, radius] of the footprint has a negative radius"});
  EXPECT_EQ(problems(with("of: [rat], heading: {variation: 200}" + area)),
            Lines{"s:21:42: expected a number 0 .. 180, got 200"});
}

TEST_F(SceneSchema, LevelOfDetailHasACameraOfItsOwn) {
  EXPECT_EQ(problems(kScene, {{"render.lod.enabled", "false"}, {"render.lod.camera", "main"}}), Lines{});
  EXPECT_EQ(problems(kScene, {{"render.lod.camera", "{position: [0, 0, 9]}"}}), Lines{});
  EXPECT_EQ(problems(kScene, {{"render.lod.camera", "mine"}}),
            Lines{"--set render.lod.camera: expected main or a block with the keys of camera, got 'mine'"});
  EXPECT_EQ(problems(kScene, {{"render.lod.enabled", "true"}, {"render.lod.quality", "2"}}), Lines{});
}

TEST_F(SceneSchema, EveryKeyIsExplained) {
  const std::string manual = manual_text(SceneDescription::schema());
  for (const char* part : {"\ncamera\n", "\ncone-shell\n", "\ncurl\n", "\nenvironment\n", "\npart\n"}) {
    EXPECT_NE(manual.find(part), std::string::npos) << part;
  }
}

}  // namespace
}  // namespace pelage
