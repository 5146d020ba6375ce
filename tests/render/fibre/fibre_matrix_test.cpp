// SPDX-License-Identifier: Apache-2.0
// What one model has and another has not: weights that are constant, reciprocity, a limit that is another
// model, and lobes of the least width.
#include <gtest/gtest.h>

#include "render/fibre/yan.h"
#include "tests/render/fibre/fibre_models.h"

namespace pelage {
namespace {

struct Place {
  float theta, h;
};
constexpr Place kPlaces[] = {{0, 0.3f}, {-0.7f, -0.85f}, {1.35f, 0.6f}};

YanParams with_tables(YanParams params) {
  params.made = MedullaTables::make(params.optics(), Workers(2), 500);
  return params;
}

template <class P>
P grey_medulla(float width) {
  P p;
  p.sigma_ca = p.sigma_ma = Rgb(0.3f);
  p.beta_m = p.beta_n = width;
  return p;
}

/// Models whose lobes are chosen by the light they carry and sampled exactly, in a colour without hue.
std::vector<MaterialParams> exact_models(float degrees, float roughness) {
  LambertCylinderParams tube;
  tube.albedo = Rgb(0.5f);
  KajiyaKayParams diffuse;
  diffuse.diffuse = 0.7f;
  diffuse.specular = Rgb(0);
  ChiangParams chiang;
  chiang.beta_m = chiang.beta_n = roughness;
  chiang.absorption = Rgb(0.3f);
  DeonParams deon;
  deon.beta = deon.azimuthal_width = degrees;
  deon.absorption = Rgb(0.3f);
  return {tube,
          diffuse,
          chiang,
          deon,
          grey_medulla<YanFastParams>(degrees),
          with_tables(grey_medulla<YanParams>(degrees))};
}

TEST(FibreMatrix, WeightsAreConstantWhereLobesAreDrawnExactly) {
  for (const MaterialParams& params : exact_models(8, 0.3f)) {
    const FibreMaterial material(params);
    for (const auto [theta, h] : kPlaces) {
      const FibreBsdf bsdf = material.at(fibre_point_at(theta, h, Rgb(0.5f)));
      TestRandom random(8);
      for (int i = 0; i < 2000; ++i) {
        const std::optional<FibreSample> s = bsdf.sample(random.unit3());
        if (!s) continue;
        ASSERT_NEAR(s->value.total().y / s->value.pdf / bsdf.albedo().y, 1, 2e-5)
            << params.index() << ' ' << theta;
      }
    }
  }
}

/// Whatever the width, no sample is lost and none weighs more than another.
TEST(FibreMatrix, LobesOfTheLeastWidthLoseNothing) {
  for (const MaterialParams& params : exact_models(0.1f, 0.02f)) {
    const FibreMaterial material(params);
    for (const auto [theta, h] : kPlaces) {
      const FibreBsdf bsdf = material.at(fibre_point_at(theta, h, Rgb(0.5f)));
      TestRandom random(9);
      constexpr int kSamples = 4000;
      double sum = 0;
      for (int i = 0; i < kSamples; ++i) {
        const std::optional<FibreSample> s = bsdf.sample(random.unit3());
        if (s) sum += s->value.total().y / s->value.pdf;
      }
      EXPECT_NEAR(sum / kSamples / bsdf.albedo().y, 1, 2e-3) << params.index() << ' ' << theta;
    }
  }
}

/// Attenuations are taken at theta_o, which keeps energy exact, so f is not symmetric: stated of Chiang
/// elsewhere, and the same for the others that were made of it.
TEST(FibreMatrix, ModelsThatAttenuateAtTheViewAreNotReciprocal) {
  std::vector<MaterialParams> models = exact_models(8, 0.3f);
  models.erase(models.begin(), models.begin() + 2);
  for (const MaterialParams& params : models) {
    const FibreMaterial material(params);
    const auto f = [&](float theta_o, float theta_i) {
      const FibrePoint point = fibre_point_at(theta_o, 0);
      return material.at(point).eval(fibre_direction(point, theta_i, kPi)).total().x / std::cos(theta_i);
    };
    EXPECT_GT(std::abs(f(0.2f, -0.35f) / f(-0.35f, 0.2f) - 1), 1e-3) << params.index();
  }
}

/// A medulla that is not there, or that does not scatter and absorbs as the cortex does, changes nothing.
TEST(FibreMatrix, WithoutMedullaItIsAClearFibre) {
  const Rgb sigma(0.1f, 0.3f, 1.0f);
  for (const auto [theta, h] : kPlaces) {
    YanOptics optics;
    optics.kappa = 0;
    const MedullaCrossing none(optics, std::sin(theta), std::cos(theta), h);
    EXPECT_EQ(none.unscattered, 1);
    EXPECT_EQ(none.scattered(), 0);
    EXPECT_FLOAT_EQ(none.in_cortex, none.surface.leg());
    const FibreCrossing clear(optics.eta, optics.layers, std::sin(theta), std::cos(theta), h);
    const auto expected = attenuations(clear.reflectance, transmittance(sigma, clear.leg()));
    const Rgb energy = expected[0] + expected[1] + expected[2] + expected[3];

    YanFastParams without = grey_medulla<YanFastParams>(9), inert = without;
    without.sigma_ca = without.sigma_ma = inert.sigma_ca = inert.sigma_ma = sigma;
    without.kappa = 0;
    inert.kappa = 0.8f;
    inert.sigma_ms = 0;
    const FibrePoint point = fibre_point_at(theta, h);
    const FibreMaterial a(without), b(inert);
    const FibreBsdf with_none = a.at(point), with_inert = b.at(point);
    TestRandom random(10);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(with_none.albedo()[k], energy[k], 1e-6);
      EXPECT_NEAR(with_inert.albedo()[k], energy[k], 1e-6);
    }
    for (int i = 0; i < 100; ++i) {
      const V3f wi = random.direction();
      const float of_none = with_none.eval(wi).total().z;
      EXPECT_NEAR(with_inert.eval(wi).total().z, of_none, 1e-6f + 1e-4f * of_none);
    }
  }
  // Half a layer of cuticle is one interface: from the front the ways are those of Chiang et al.
  const auto one = attenuations(FibreCrossing(1.55f, 0, 0, 1, 0).reflectance, Rgb(1));
  const auto half = attenuations(FibreCrossing(1.55f, 0.5f, 0, 1, 0).reflectance, Rgb(1));
  for (int p = 0; p < kFibreLobes; ++p) EXPECT_NEAR(one[p].x, half[p].x, 1e-6);
}

}  // namespace
}  // namespace pelage
