// SPDX-License-Identifier: Apache-2.0 Brightness of tangles of fibres.
#include <gtest/gtest.h>

#include "tests/render/fibre/tangle_brightness.h"

namespace pelage {
namespace {

/// For fibres that scatter evenly in all directions, the reflectance is the diffuse albedo of an infinitely
/// deep medium of isotropic scatterers of albedo a. With s = sqrt(1 - a), the fit of [Hulst80, table 12] is
/// (1 - s) (1 - 0.139 s) / (1 + 1.17 s).
TEST(Tangle, OfIsotropicScatterers) {
  for (float albedo : {0.3f, 0.8f, 0.97f}) {
    const double s = std::sqrt(1 - albedo), expected = (1 - s) * (1 - 0.139 * s) / (1 + 1.17 * s);
    const double found = tangle_reflectance(
        [&](const TangleHit&, const V3f& u) {
          const float z = 2 * u.x - 1, across = std::sqrt((1 - z) * (1 + z)), turn = 2 * kPi * u.y;
          FibreSample sample;
          sample.wi = {across * std::cos(turn), across * std::sin(turn), z};
          sample.value[LobeGroup::kDiffuse] = Rgb(albedo * 0.25f / kPi);
          sample.value.pdf = 0.25f / kPi;
          return std::optional(sample);
        },
        20000, FibreLay::tangle());
    EXPECT_NEAR(found / expected, 1, 0.04) << albedo;
  }
}

/// The constants of the table are correct, and the fit of [Chiang16] gives nearly the colour of a coat.
TEST(CoatColor, BrightnessIsThatOfChiangFibres) {
  const FibreMaterial chiang{ChiangParams{}};
  for (int i = 2; i < CoatColor::kColors; i += 2) {
    const float color = CoatColor::kColor[i];
    const double found = brightness(chiang, color, 4000);
    EXPECT_NEAR(found / CoatColor::kBrightness[i], 1, 0.06) << color;
    EXPECT_NEAR(CoatColor::kBrightness[i], color, 0.08);
  }
}

/// `color` means the same for every model.
TEST(CoatColor, EveryModelIsAsBright) {
  const MaterialParams models[] = {LambertCylinderParams{}, KajiyaKayParams{},
                                   ConeShellParams{},       DeonParams{},
                                   MarschnerParams{},       YanFastParams{}};
  for (const MaterialParams& params : models) {
    const FibreMaterial material(params, Workers(2));
    for (int i : {1, 3, 6, 8}) {
      const float color = CoatColor::kColor[i];
      EXPECT_NEAR(brightness(material, color, 3000) / CoatColor::kBrightness[i], 1, 0.07)
          << params.index() << ' ' << color;
    }
  }
}

/// The halved Marschner model fails to keep white fur white. A Gaussian in theta_h, halved, reflects a few
/// hundredths less light than arrives; the more slanted the fibre, the larger the loss. In a mass of white
/// fur, light is scattered dozens of times, so fur that absorbs nothing is far from white. The same lobes,
/// scaled to conserve energy or with the longitudinal function of [dEon11], lose little light. So the height
/// of the lobes causes the loss, not their implementation.
TEST(CoatColor, HalvedMarschnerIsTooDarkWithoutAbsorption) {
  MarschnerParams clear;
  clear.absorption = Rgb(0);
  EXPECT_GT(brightness(FibreMaterial(clear), 1, 2000), 0.9);
  clear.variant = MarschnerVariant::kHalved;
  EXPECT_LT(brightness(FibreMaterial(clear), 1, 2000), 0.85);
  EXPECT_GT(brightness(FibreMaterial(DeonParams{}), 1, 2000), 0.9);
}

}  // namespace
}  // namespace pelage
