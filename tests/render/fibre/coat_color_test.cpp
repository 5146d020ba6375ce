// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/coat_color.h"

#include <gtest/gtest.h>

#include "tests/render/fibre/tangle_brightness.h"

namespace pelage {
namespace {

TEST(CoatColor, WhiteAbsorbsNothingAndDarkerAbsorbsMore) {
  const FibreMaterial material(LambertCylinderParams{});
  const CoatColor& by_color = *material.coat_color();
  EXPECT_EQ(by_color(Rgb(1)), Rgb(0));
  EXPECT_EQ(by_color(Rgb(2)), Rgb(0));
  EXPECT_EQ(by_color(Rgb(0)), by_color(Rgb(0.001f)));
  float before = 0;
  for (float color = 0.99f; color > 0.002f; color *= 0.9f) {
    const float t = by_color(Rgb(color)).x;
    EXPECT_GT(t, before);
    before = t;
  }
}

TEST(CoatColor, IsTheSameForAnyNumberOfThreads) {
  const FibreMaterial one{KajiyaKayParams{}}, three(KajiyaKayParams{}, Workers(3));
  for (float color : {0.02f, 0.4f, 0.93f})
    EXPECT_EQ((*one.coat_color())(Rgb(color)), (*three.coat_color())(Rgb(color)));
}

/// Where what a fibre absorbs or reflects is given, the colour steps back or tints, and nothing is matched.
TEST(CoatColor, IsNotAskedWhereAlbedosAreGiven) {
  ConeShellParams cone;
  cone.diffuse = 0.7f;
  YanFastParams yan;
  yan.preset = YanPreset::kRowA;
  MarschnerParams marschner;
  marschner.eumelanin = 1.0f;
  for (const MaterialParams& params :
       {MaterialParams(cone), MaterialParams(yan), MaterialParams(marschner), MaterialParams(ChiangParams{})})
    EXPECT_EQ(FibreMaterial(params).coat_color(), nullptr);
}

/// A few walks of every model. How bright the tangles are is measured in coat_brightness_test.cpp.
TEST(Tangle, GivesLightBackWhateverTheModel) {
  ConeShellParams cone;
  cone.diffuse = 0.7f;
  LambertCylinderParams cylinder;
  cylinder.albedo = Rgb(0.7f);
  KajiyaKayParams kajiya;
  kajiya.diffuse = 0.7f;
  MarschnerParams marschner;
  marschner.eumelanin = 0.3f;
  YanFastParams yan;
  yan.preset = YanPreset::kRowA;
  const MaterialParams models[] = {cone, cylinder, kajiya, marschner, yan, ChiangParams{}, DeonParams{}};
  for (const MaterialParams& params : models) {
    const double found = brightness(FibreMaterial(params), 0.8f, 100);
    EXPECT_GT(found, 0) << params.index();
    EXPECT_LT(found, 1.1) << params.index();
  }
}

/// The published lobes scatter nearly twice the light that arrives. So even white fibres must absorb;
/// otherwise the light in a mass of fibres would grow without bound.
TEST(CoatColor, PublishedMarschnerAbsorbsEvenWhereItIsWhite) {
  MarschnerParams params;
  params.variant = MarschnerVariant::kPublished;
  EXPECT_GT((*FibreMaterial(params).coat_color())(Rgb(1)).x, 0.1f);
}

}  // namespace
}  // namespace pelage
