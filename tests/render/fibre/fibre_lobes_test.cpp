// SPDX-License-Identifier: Apache-2.0
// The pieces that physical models are put together from.
#include <gtest/gtest.h>

#include "render/fibre/attenuation.h"
#include "render/fibre/azimuthal.h"
#include "render/fibre/dielectric.h"
#include "render/fibre/longitudinal.h"
#include "render/material/absorption.h"
#include "render/material/fibre_params.h"
#include "render/material/yan_params.h"
#include "tests/render/random.h"
#include "tests/support/chi_square.h"

namespace pelage::fibre_lobes_test {
namespace {

constexpr double kPiD = std::numbers::pi;

double series_i0(double x) {
  double term = 1, sum = 1;
  for (int k = 1; k < 500; ++k) sum += term *= x * x / (4.0 * k * k);
  return sum;
}

TEST(Dielectric, AgreesWithKnownValues) {
  EXPECT_NEAR(dielectric_reflectance(1, 1.55f), 0.04652057, 1e-7);
  EXPECT_NEAR(dielectric_reflectance(std::sqrt(0.75f), 1.55f), 0.04813992, 1e-7);
  EXPECT_NEAR(dielectric_reflectance(0.8f * std::sqrt(0.19f), 1.55f), 0.17484850, 1e-6);
  EXPECT_FLOAT_EQ(dielectric_reflectance(0, 1.3f), 1);
}

TEST(Dielectric, HalfALayerOfCuticleIsOneInterface) {
  EXPECT_NEAR(cuticle_reflectance(1, 1.55f, 0.5f), dielectric_reflectance(1, 1.55f), 1e-7);
  EXPECT_GT(cuticle_reflectance(1, 1.55f, 1), 1.8f * dielectric_reflectance(1, 1.55f));
  EXPECT_NEAR(cuticle_reflectance(0, 1.55f, 0.5f), 1, 1e-6);
  for (float layers : {0.5f, 0.68f, 3.0f}) {
    for (float c = 0; c <= 1; c += 0.05f) {
      EXPECT_GE(cuticle_reflectance(c, 1.55f, layers), 0);
      EXPECT_LE(cuticle_reflectance(c, 1.55f, layers), 1);
    }
  }
}

TEST(Longitudinal, BesselFunctionIsGoodEverywhere) {
  for (double x : {0.0, 0.1, 1.0, 3.7, 3.8, 8.0, 11.99, 12.01, 15.0, 60.0}) {
    const double expected = x < 40 ? series_i0(x) * std::exp(-x)
                                   : (1 + 1 / (8 * x) + 9 / (128 * x * x)) / std::sqrt(2 * kPiD * x);
    EXPECT_NEAR(bessel_i0_exp(static_cast<float>(x), static_cast<float>(-x)) / expected, 1, 4e-6) << x;
  }
}

TEST(Longitudinal, IntegratesToOneFromTheSharpestToTheBluntest) {
  for (float v : {1e-6f, 1e-5f, 1e-3f, 0.05f, 0.2f, 0.9f, 1.1f, 6.0f, 110.0f}) {
    const LongitudinalLobe lobe(v);
    for (double theta_o : {0.0, 0.5, -1.2, 1.5}) {
      const double s = std::sin(theta_o), c = std::cos(theta_o);
      const double reach = std::min(kPiD, 9 * std::sqrt(double(v)));
      const double low = std::max(-kPiD / 2, -theta_o - reach), high = std::min(kPiD / 2, -theta_o + reach);
      constexpr int kSteps = 4000;
      double sum = 0;
      for (int i = 0; i < kSteps; ++i) {
        const double t = low + (high - low) * (i + 0.5) / kSteps;
        sum += lobe.density(std::sin(t), std::cos(t), s, c) * std::cos(t);
      }
      EXPECT_NEAR(sum * (high - low) / kSteps, 1, v < 1e-4f ? 4e-3 : 1e-3) << v << " " << theta_o;
    }
  }
}

TEST(Longitudinal, SamplesAsTheFormulaSays) {
  const float s = std::sin(0.3f), c = std::cos(0.3f);
  EXPECT_NEAR(LongitudinalLobe(.0846111692f).sample({0.4f, 0.1f}, s, c), .02577428, 1e-6);
  EXPECT_NEAR(LongitudinalLobe(.00651572f).sample({0.4f, 0.1f}, s, c), -.20942672, 1e-6);
}

/// Smooth fibres: samples follow the density, cell by cell about the peak.
TEST(Longitudinal, NarrowLobesPassChiSquare) {
  const double level = sidak_level(1e-4, 9);
  uint64_t seed = 40;
  for (float v : {1e-5f, 2e-4f, 6e-3f}) {
    const LongitudinalLobe lobe(v);
    for (double theta_o : {0.0, 0.6, -1.2}) {
      constexpr int kCells = 40, kSamples = 50000, kSteps = 16;
      const double s = std::sin(theta_o), c = std::cos(theta_o), reach = 4 * std::sqrt(double(v));
      const auto at = [&](double cell) { return -theta_o + reach * (2 * cell / kCells - 1); };
      std::vector<double> expected(kCells + 1), observed(kCells + 1);
      double inside = 0;
      for (int i = 0; i < kCells; ++i) {
        for (int k = 0; k < kSteps; ++k) {
          const double t = at(i + (k + 0.5) / kSteps);
          if (std::abs(t) > kPiD / 2) continue;
          expected[i] += lobe.density(std::sin(t), std::cos(t), s, c) * std::cos(t) * kSamples *
                         (2 * reach / kCells / kSteps);
        }
        inside += expected[i];
      }
      expected[kCells] = std::max(0.0, kSamples - inside);
      TestRandom random(++seed);
      for (int i = 0; i < kSamples; ++i) {
        const double t = std::asin(double(lobe.sample(random.unit2(), s, c)));
        const double cell = std::floor(((t + theta_o) / reach + 1) / 2 * kCells);
        observed[cell >= 0 && cell < kCells ? static_cast<size_t>(cell) : kCells] += 1;
      }
      const ChiSquare test = chi_square(observed, expected);
      EXPECT_GT(test.p, level) << v << ' ' << theta_o << ": " << test.statistic << " / " << test.dof;
    }
  }
}

TEST(Azimuthal, TrimmedLogistic) {
  const TrimmedLogistic lobe(.11715981f);
  EXPECT_NEAR(lobe.sample(0.1f), -.25742641, 1e-6);
  EXPECT_NEAR(lobe.sample(0.8f), .16241798, 1e-6);
  for (float s : {0.002f, 0.1f, 0.7f, 4.3f}) {
    const TrimmedLogistic l(s);
    double sum = 0;
    for (int i = 0; i < 40000; ++i) sum += l.density(static_cast<float>(kPiD * ((i + 0.5) / 20000 - 1)));
    EXPECT_NEAR(sum * kPiD / 20000, 1, 1e-3) << s;
    EXPECT_NEAR(l.sample(0), -kPiD, 1e-3);
  }
}

TEST(Azimuthal, WrappedGaussian) {
  for (float s : {0.002f, 0.3f, 0.5f, 0.99f, 1.0f, 1.9f}) {
    const WrappedGaussian l(s);
    double sum = 0;
    for (int i = 0; i < 40000; ++i) sum += l.density(static_cast<float>(kPiD * ((i + 0.5) / 20000 - 1)));
    EXPECT_NEAR(sum * kPiD / 20000, 1, 1e-4) << s;
  }
  for (float x : {-0.9999f, -0.5f, 0.0f, 0.3f, 0.99f, 0.99999f}) {
    EXPECT_NEAR(std::erf(inverse_erf(x)), x, 3e-7);
  }
}

TEST(Attenuation, AgreesWithKnownValues) {
  const auto a = attenuations(FibreCrossing(1.55f, 0, 0, 1, 0).reflectance, Rgb(1));
  EXPECT_NEAR(a[0].x, .04652057, 1e-6);
  EXPECT_NEAR(a[1].x, .90912303, 1e-6);
  EXPECT_NEAR(a[2].x, .04229292, 1e-6);
  EXPECT_NEAR(a[3].x, .00206349, 1e-6);
  const FibreCrossing slanted(1.55f, 0, 0.6f, 0.8f, 0.5f);
  const Rgb t = transmittance(Rgb(0.5f), slanted.leg());
  EXPECT_NEAR(t.x, .35302828, 1e-6);
  const auto b = attenuations(slanted.reflectance, t);
  EXPECT_NEAR(b[0].x, .05873982, 1e-6);
  EXPECT_NEAR(b[1].x, .31277272, 1e-6);
  EXPECT_NEAR(b[2].x, .00648591, 1e-6);
  EXPECT_NEAR(b[3].x, .00013735, 1e-6);
  EXPECT_NEAR(FibreCrossing(1.55f, 0, 0, 1, 0.5f).gamma_t, .32845462, 1e-6);
  EXPECT_NEAR(FibreCrossing(1.55f, 0, 0.6f, 0.8f, -0.9f).gamma_t, -.52798323, 1e-6);
}

TEST(Attenuation, NothingIsLostWithoutAbsorption) {
  for (float h = -1; h <= 1; h += 0.01f) {
    for (float theta : {0.0f, 0.7f, 1.5f, 1.57f}) {
      const FibreCrossing c(1.55f, 0, std::sin(theta), std::max(1e-4f, std::cos(theta)), h);
      const auto a = attenuations(c.reflectance, Rgb(1));
      EXPECT_NEAR(a[0].x + a[1].x + a[2].x + a[3].x, 1, 2e-6) << h << ' ' << theta;
    }
  }
}

TEST(Absorption, OfColoursAndPigments) {
  const ColorToAbsorption by_color(0.3f);
  EXPECT_NEAR(by_color(Rgb(.1f)).x, .15290954, 1e-6);
  EXPECT_NEAR(by_color(Rgb(.5f)).x, .01385652, 1e-7);
  EXPECT_NEAR(by_color(Rgb(.9f)).x, .00032015, 1e-7);
  EXPECT_EQ(by_color(Rgb(1)), Rgb(0));
  EXPECT_EQ(by_color(Rgb(0)), by_color(Rgb(1e-3f)));
  EXPECT_NEAR(melanin_absorption(1.3f, 0).y, 1.3 * 0.697, 1e-6);
  // Of each pigment alone, and of the mixture of a material [dEon11].
  EXPECT_EQ(melanin_absorption(1, 0), Rgb(0.419f, 0.697f, 1.37f));
  EXPECT_EQ(melanin_absorption(0, 1), Rgb(0.187f, 0.4f, 1.05f));
  ChiangParams red;
  red.preset = HairPreset::kHumanBlack;  // the block replaces it
  red.melanin = {0.2f, 0.6f};
  EXPECT_EQ(*given_absorption(red), melanin_absorption(0.2f, 0.6f));
  red.pheomelanin = 1.0f;
  EXPECT_EQ(*given_absorption(red), melanin_absorption(0.2f, 1));
  YanFastParams fur;
  fur.melanin = {0.2f, 0.6f};
  fur.sigma_ma = Rgb(0.5f);
  EXPECT_EQ(*fur.optics().sigma_ca, melanin_absorption(0.2f, 0.6f));
  EXPECT_EQ(*fur.optics().sigma_ma, Rgb(0.5f));
}

}  // namespace
}  // namespace pelage::fibre_lobes_test
