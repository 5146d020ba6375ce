// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/marschner.h"

#include <gtest/gtest.h>

#include "tests/render/fibre/fibre_models.h"

namespace pelage {
namespace {

MarschnerParams clear(float alpha, float beta, MarschnerVariant variant) {
  MarschnerParams p;
  p.alpha = alpha;
  p.beta = beta;
  p.variant = variant;
  p.absorption = Rgb(0);
  return p;
}

double far_albedo(const MarschnerParams& params, float theta_o) {
  const MarschnerMaterial material(params);
  RunningMean mean;
  TestRandom random(3);
  for (int i = 0; i < 20000; ++i) {
    const float h = 2 * (static_cast<float>(i) + 0.5f) / 20000 - 1;
    const FibrePoint point = fibre_point_at(theta_o, h);
    const auto s = material.at(FibreFrame(point.tangents[0], point.wo), h, Rgb(1)).sample(random.unit3());
    mean.add(s ? s->value.total().x / s->value.pdf : 0.0f);
  }
  EXPECT_LT(mean.standard_error(), 0.01);
  return mean.mean();
}

/// A known defect of the model: a Gaussian of unit area in theta_h has area 2 in theta_i, so a fibre without
/// absorption scatters nearly twice the light that arrives. The halved lobes scatter the correct amount of
/// light.
TEST(Marschner, PublishedGivesBackNearlyTwiceWhatItGets) {
  for (float theta : {0.0f, 0.5f, 1.0f}) {
    const double published = far_albedo(clear(0, 5, MarschnerVariant::kPublished), theta);
    EXPECT_GT(published, 1.8);
    EXPECT_LT(published, 2.0);
    const double halved = far_albedo(clear(0, 5, MarschnerVariant::kHalved), theta);
    EXPECT_NEAR(halved, published / 2, 1e-4);
    EXPECT_LT(halved, 1);
  }
}

/// Another one: lobes that the cuticle shifts are not normalised by cos^2(theta_d), so that a slanted fibre
/// gains energy even when halved.
TEST(Marschner, ShiftedLobesGainEnergyOnSlantedFibres) {
  EXPECT_GT(far_albedo(clear(-7.5f, 5, MarschnerVariant::kHalved), 1.0f), 1.05);
}

/// The conserving lobes scatter all light, however slanted the fibre, and with lobes of any width and shift.
/// One standard error is at most 0.006 (20,000 samples whose weights differ by less than their mean).
TEST(Marschner, ConservingScattersAllLight) {
  for (float alpha : {-10.0f, 0.0f}) {
    for (float beta : {1.0f, 7.5f, 20.0f}) {
      for (float theta : {-1.3f, -0.7f, 0.0f, 0.4f, 1.0f, 1.4f})
        EXPECT_NEAR(far_albedo(clear(alpha, beta, MarschnerVariant::kConserving), theta), 1, 0.02)
            << alpha << ' ' << beta << ' ' << theta;
    }
  }
}

/// At every inclination, its lobes are those of the published variant times one number.
TEST(Marschner, ConservingScalesThePublishedLobes) {
  MarschnerParams params = clear(-5, 6, MarschnerVariant::kConserving);
  params.absorption = Rgb(0.1f, 0.4f, 1.0f);
  const MarschnerMaterial conserving(params);
  params.variant = MarschnerVariant::kPublished;
  const MarschnerMaterial published(params);
  TestRandom random(4);
  for (float theta : {-1.2f, 0.3f}) {
    float scale = 0;
    for (int i = 0; i < 50; ++i) {
      const float h = 2 * random.unit() - 1;
      const FibrePoint point = fibre_point_at(theta, h);
      const FibreFrame frame(point.tangents[0], point.wo);
      const V3f wi = random.direction();
      const Rgb ours = conserving.at(frame, h, Rgb(1)).eval(wi).total(),
                theirs = published.at(frame, h, Rgb(1)).eval(wi).total();
      if (!(theirs.z > 1e-6f)) continue;
      if (scale == 0) scale = ours.y / theirs.y;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(ours[c] / theirs[c], scale, 1e-4f * scale);
    }
    EXPECT_GT(scale, 0.4f);
    EXPECT_LT(scale, 1.0f);
  }
}

/// integral of M cos^2(theta_i) / cos^2(theta_d) d theta_i for beta = 5 and 5 / 2 degrees.
TEST(Marschner, EnergyOfTheLongitudinalFunction) {
  struct Row {
    float theta_o;
    double energy;
  };
  for (const Row& row : {Row{0, 1.955}, Row{.5f, 1.951}, Row{1, 1.924}, Row{1.3f, 1.877}}) {
    MarschnerParams params = clear(0, 5, MarschnerVariant::kPublished);
    params.absorption = Rgb(1000);  // R alone
    const MarschnerMaterial material(params);
    constexpr float kH = 0.2f;
    const FibrePoint point = fibre_point_at(row.theta_o, kH);
    const MarschnerBsdf bsdf = material.at(FibreFrame(point.tangents[0], point.wo), kH, Rgb(1));
    const double sum = sphere_integral(
        fibre_grid(point),
        [&](const V3f& w) {
          const float theta_d = 0.5f * (row.theta_o - std::asin(w.dot(point.tangents[0])));
          const FibreCrossing crossing(1.55f, 0, std::sin(theta_d), std::cos(theta_d), kH);
          return bsdf.eval(w).total().x / crossing.reflectance;
        },
        2000, 64);
    EXPECT_NEAR(sum, row.energy, 4e-3);
  }
}

/// S is symmetric where the cuticle is not tilted; at one h it is so together with the mirrored h.
TEST(Marschner, IsReciprocalWithoutTilt) {
  MarschnerParams params = clear(0, 9, MarschnerVariant::kPublished);
  params.absorption = Rgb(0.3f);
  params.azimuthal_width = 30;
  const MarschnerMaterial material(params);
  TestRandom random(2);
  for (int i = 0; i < 200; ++i) {
    const V3f t = random.direction(), a = random.direction(), b = random.direction();
    const float h = random.unit();
    const auto f = [&](const V3f& wo, const V3f& wi) {
      float sum = 0;
      for (float side : {h, -h}) sum += material.at(FibreFrame(t, wo), side, Rgb(1)).eval(wi).total().x;
      return sum / std::sqrt(1 - wi.dot(t) * wi.dot(t));
    };
    const float there = f(a, b), back = f(b, a);
    EXPECT_NEAR(there, back, 1e-5f + 2e-3f * std::abs(there));
  }
}

/// TRT turns around at h_c = sqrt((4 - eta^2) / 3), where the paper's far field is infinite [Marschner03,
/// section 5.2.2]: azimuths from the way back, in degrees.
TEST(Marschner, TrtTurnsAroundAtTheCaustic) {
  struct Row {
    float eta;
    double degrees;
  };
  for (const Row& row : {Row{1.55f, 18.6158}, Row{1.7f, 8.933}, Row{1.9f, 1.488}}) {
    const auto azimuth = [&](double h) {
      return FibreCrossing(row.eta, 0, 0, 1, static_cast<float>(h)).exit_azimuth(2) * 180 / kPi;
    };
    const double h = std::sqrt((4 - double(row.eta) * row.eta) / 3);
    EXPECT_NEAR(std::abs(azimuth(h)), row.degrees, 2e-3) << row.eta;
    EXPECT_NEAR((azimuth(h + 0.01) - azimuth(h - 0.01)) / 0.02, 0, 0.1) << row.eta;
    EXPECT_LT(std::abs(azimuth(h + 0.05)), std::abs(azimuth(h))) << row.eta;
    EXPECT_LT(std::abs(azimuth(h - 0.05)), std::abs(azimuth(h))) << row.eta;
  }
  EXPECT_NEAR(std::sqrt((4 - 1.55 * 1.55) / 3), .729726, 1e-6);
}

/// Where the far field has roots, they are what a narrow blur tends to: N_p = A(p, h) / |2 d Phi / d h|
/// [Marschner03, equation 8], here for R and TT, which have one root each.
TEST(Marschner, ANarrowBlurTendsToTheRootsOfThePaper) {
  const float sigma = 0.2f;
  for (int p : {0, 1}) {
    for (float h : {0.3f, -0.55f}) {
      const auto azimuth = [&](float at) { return FibreCrossing(1.55f, 0, 0, 1, at).exit_azimuth(p); };
      const FibreCrossing crossing(1.55f, 0, 0, 1, h);
      const Rgb t = transmittance(Rgb(sigma), crossing.leg());
      const float a = attenuations(crossing.reflectance, t)[p].x;
      const float slope = wrapped_angle(azimuth(h + 1e-3f) - azimuth(h - 1e-3f)) / 2e-3f;
      const double expected = a / std::abs(2 * slope);
      const WrappedGaussian blur(0.01f);
      double sum = 0;
      constexpr int kOffsets = 20000;
      for (int k = 0; k < kOffsets; ++k) {
        const float at = 2 * (static_cast<float>(k) + 0.5f) / kOffsets - 1;
        const FibreCrossing c(1.55f, 0, 0, 1, at);
        sum += attenuations(c.reflectance, transmittance(Rgb(sigma), c.leg()))[p].x *
               blur.density(wrapped_angle(crossing.exit_azimuth(p) - c.exit_azimuth(p))) / kOffsets;
      }
      EXPECT_NEAR(sum / expected, 1, 0.01);
    }
  }
}

}  // namespace
}  // namespace pelage
