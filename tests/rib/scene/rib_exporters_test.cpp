// SPDX-License-Identifier: Apache-2.0
// Requests as exporters write them, which readers of the standard alone would refuse or misread.
#include <set>

#include "tests/rib/scene/rib_scenes.h"

namespace pelage::rib_exporters_test {
namespace {

using namespace rib_test;

// The messages of warnings, in order.
std::vector<std::string> warnings(const std::string& text) {
  std::vector<std::string> messages;
  for (const Problem& warning : read(text).warnings) messages.push_back(warning.message);
  return messages;
}

TEST(RibExporters, WhatIsMissingIsAWarning) {
  using Lines = std::vector<std::string>;
  EXPECT_EQ(warnings("ReadArchive \"none.rib\" ReadArchive \"none.rib\""),
            Lines{"ReadArchive: no such file 'none.rib' beside the file or on the search path; skipped"});
  EXPECT_EQ(warnings("Procedural \"DelayedReadArchive\" [\"/none.rib\"] [0 1 0 1 0 1]"),
            Lines{"Procedural: no such file '/none.rib'; skipped"});
  EXPECT_EQ(warnings("LightSource \"envlight\" 1 \"string filename\" \"occl.sm\""),
            Lines{"LightSource: no such file 'occl.sm' beside the file or on the search path; skipped"});
  EXPECT_EQ(warnings("ObjectInstance 2"), Lines{"there is no object '#2'; skipped"});
  EXPECT_EQ(warnings("Declare \"x\" \"flaot\""),
            Lines{"Declare: 'flaot' is no class and type that Pelage knows; skipped"});
  EXPECT_EQ(warnings("PointsPolygons [] [] \"P\" []"),
            Lines{"PointsPolygons: a mesh without faces is skipped"});
}

TEST(RibExporters, RoundingInMatricesIsNoPerspective) {
  expect_near(tip("ConcatTransform [1 0 0 -8.5e-10 0 1 0 1e-7 0 0 1 0 5 6 7 1] " + kHair), {5, 7, 7});
  expect_near(tip("ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 0.9999999] " + kHair), {5, 7, 7});
  expect_near(tip("ConcatTransform [2 0 0 0 0 2 0 0 0 0 2 0 2 2 2 2] " + kHair), {1, 2, 1});
}

TEST(RibExporters, ThingsWithoutExtentAreDroppedAndCounted) {
  const std::string short_curves =
      "Curves \"linear\" [1 2 1] \"nonperiodic\" \"P\" [0 0 0 0 0 0 0 1 0 0 0 0] "
      "\"constantwidth\" .1\n";
  const RibScene scene = read("Color 1 0 0\n" + short_curves + short_curves + "AttributeBegin Scale 0 0 0 " +
                              kHair + "PointsPolygons [3] [0 1 2] \"P\" [0 0 0 1 0 0 0 1 0] AttributeEnd");
  EXPECT_EQ(tips(scene).size(), 2u);
  EXPECT_TRUE(scene.skins.empty());
  ASSERT_EQ(scene.warnings.size(), 2u);
  EXPECT_EQ(scene.warnings[0].message, "things whose transform has no inverse are dropped");
  EXPECT_EQ(scene.warnings[1].message, "dropped curves whose points do not form whole segments: 4");
  EXPECT_EQ(scene.warnings[1].position.line, 2);
}

TEST(RibExporters, NumbersThatAreNotFiniteAreNamed) {
  for (const char* word : {"nan", "-nan", "NaN", "inf", "-inf", "1.#QNAN", "-1.#IND", "1.#INF"}) {
    const std::string message = failure(std::string("Polygon \"P\" [0 0 0 1 0 0 1 1 ") + word + "]");
    EXPECT_EQ(message, "a.rib:1:30: '" + std::string(word) + "' is not a number");
  }
  expect_near(tip("Translate 0 0 1.#a comment\n" + kHair), {0, 1, 1});
}

TEST(RibExporters, ShadowPassesAreNoPictures) {
  const auto frame = [](int number, const std::string& display, float z) {
    return "FrameBegin " + std::to_string(number) + " Display \"x\" " + display +
           " ScreenWindow -9 9 -9 9 Translate 0 0 " + std::to_string(z) + " WorldBegin " + kHair +
           "WorldEnd FrameEnd\n";
  };
  const std::string shadow = "\"shadow\" \"z\"", picture = "\"file\" \"rgba\"";
  RibScene scene =
      read(frame(1, shadow, 1) + "FrameBegin 2 Display \"y\" \"file\" \"rgb\" Translate 0 0 2 WorldBegin " +
           kHair + "WorldEnd FrameEnd");
  EXPECT_EQ(scene.frame, 2);
  EXPECT_EQ(scene.camera.to_camera.at(0).translation().z, 2);
  EXPECT_FALSE(scene.camera.screen_window) << "of another frame";
  EXPECT_FALSE(scene.shadow_pass);
  RibReadOptions first;
  first.frame = 1;
  scene = read(frame(1, shadow, 1) + frame(1, picture, 3) + frame(2, picture, 2), first);
  EXPECT_EQ(scene.camera.to_camera.at(0).translation().z, 3) << "some exporters number passes alike";
  EXPECT_FALSE(scene.shadow_pass);
  scene = read(frame(1, shadow, 1) + frame(2, shadow, 2));
  EXPECT_TRUE(scene.shadow_pass) << "better than nothing";
  EXPECT_EQ(scene.frame, 1);
  EXPECT_EQ(scene.camera.to_camera.at(0).translation().z, 1);
}

TEST(RibExporters, LightsBeforeTheWorldAreInCameraSpace) {
  const RibScene scene = read(
      "Projection \"perspective\" Translate 0 0 5 TransformBegin Translate 0 0 1 LightSource \"pointlight\" "
      "1 "
      "TransformEnd Scale 1 1 -1 WorldBegin LightSource \"pointlight\" 2 WorldEnd");
  ASSERT_EQ(scene.lights.size(), 2u);
  expect_near(V3f(0) * scene.lights[0].to_world.at(0), {0, 0, -1});
  expect_near(V3f(0) * scene.lights[1].to_world.at(0), {0, 0, 0});
}

TEST(RibExporters, CamerasOfRis) {
  const RibScene scene = read(
      "Option \"Ri\" \"int[2] FormatResolution\" [64 48] \"float FormatPixelAspectRatio\" [1] Hider "
      "\"raytrace\" \"int "
      "maxsamples\" [16] Projection \"PxrPerspective\" \"float fov\" [40] TransformBegin Translate 0 0 7 "
      "Camera \"cam\" "
      "TransformEnd WorldBegin WorldEnd");
  EXPECT_TRUE(scene.camera.perspective);
  EXPECT_EQ(scene.camera.fov, 40);
  EXPECT_EQ(scene.camera.format->second, 48);
  EXPECT_EQ(scene.camera.pixel_samples->x, 16);
  EXPECT_EQ(scene.camera.to_camera.at(0).translation().z, 7);
  EXPECT_FALSE(read("WorldBegin WorldEnd").camera.perspective) << "the default of RI";
}

TEST(RibExporters, MotionBlocksOfAClosedShutter) {
  EXPECT_EQ(read("MotionBegin [0 0] Translate 1 0 0 Translate 2 0 0 MotionEnd " + kHair)
                .coats[0]
                .batches[0]
                ->point(0)
                .x,
            1);
}

TEST(RibExporters, EachNameIsUniqueAtOnce) {
  std::string text;
  for (int i = 0; i < 20'000; ++i) text += "LightSource \"pointlight\" 1 ";
  const RibScene scene = read(text);
  std::set<std::string> names;
  for (const RibLight& light : scene.lights) names.insert(light.name);
  EXPECT_EQ(names.size(), 20'000u);
  EXPECT_TRUE(names.contains("pointlight.20000"));
}

TEST(RibExporters, NodesOfRisAreSurfacesWithConstantInputs) {
  const RibScene scene = read(
      "AttributeBegin Pattern \"PxrConstant\" \"red\" \"color color\" [1 0 0] Pattern \"PxrInvert\" "
      "\"through\" "
      "\"reference color inputRGB\" [\"red:resultRGB\"] Pattern \"PxrHairColor\" \"brown\" \"float melanin\" "
      "[0.6] "
      "Bxdf \"PxrSurface\" \"skin\" \"reference color diffuseColor\" [\"through:resultRGB\"] \"reference "
      "color "
      "specularFaceColor\" [\"none:x\"] \"float diffuseGain\" [0.5] PointsPolygons [3] [0 1 2] \"P\" [0 0 0 "
      "1 0 0 0 1 0] "
      "Bxdf \"PxrMarschnerHair\" \"hair\" \"reference color diffuseColor\" [\"brown:resultDiff\"] " +
      kHair + "AttributeEnd " + kHair);
  ASSERT_EQ(scene.materials.size(), 3u);
  EXPECT_EQ(scene.materials[0].name, "skin");
  EXPECT_EQ(scene.materials[0].shader->name, "PxrSurface");
  ASSERT_TRUE(scene.materials[0].shader->find("diffuseColor"));
  EXPECT_EQ(scene.materials[0].shader->find("diffuseColor")->numbers, (std::vector<float>{1, 0, 0}));
  EXPECT_FALSE(scene.materials[0].shader->find("specularFaceColor"));
  const std::vector<float>& brown = scene.materials[1].shader->find("diffuseColor")->numbers;
  EXPECT_TRUE(brown[0] > brown[1] && brown[1] > brown[2] && brown[2] > 0);
  EXPECT_FALSE(scene.materials[2].shader) << "attributes end with their block";
  EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST(RibExporters, OpacityIsPartOfTheMaterial) {
  const RibScene scene =
      read("Opacity .3 .3 .3 " + kHair + "Opacity 1 1 1 " + kHair + "Opacity 0 0 0 Sphere 1 -1 1 360");
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_FLOAT_EQ(scene.materials[0].opacity, .3f);
  EXPECT_TRUE(scene.skins.empty()) << "an invisible mesh";
}

}  // namespace
}  // namespace pelage::rib_exporters_test
