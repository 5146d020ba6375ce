// SPDX-License-Identifier: Apache-2.0
#include "render/surface/glossy.h"

#include <gtest/gtest.h>

#include "tests/render/random.h"
#include "tests/render/sphere_statistics.h"

namespace pelage {
namespace {

const V3f kNormal = V3f(0.3f, -0.5f, 0.8f).normalized();

// Viewing direction at an angle from the normal.
V3f viewer(float angle) {
  V3f x, y;
  complete_frame(kNormal, x, y);
  return std::cos(angle) * kNormal + std::sin(angle) * (0.6f * x + 0.8f * y);
}

struct Case {
  float roughness, ior, angle;
};
const Case kCases[] = {
    {0.3f, 1.5f, 0.2f}, {0.5f, 1.5f, 1.2f}, {0.8f, 1.33f, 0.7f}, {0.4f, 2.4f, 1.45f}, {1.0f, 1.8f, 0.0f}};

TEST(Glossy, DrawsByItsDensity) {
  const double level = sidak_level(1e-4, std::size(kCases));
  for (const Case& c : kCases) {
    const GlossyBsdf bsdf(Rgb(0.4f, 0.3f, 0.2f), c.roughness, c.ior, kNormal, viewer(c.angle));
    TestRandom random(7);
    const auto sample = [&](int) -> std::optional<V3f> {
      const auto drawn = bsdf.sample(random.unit3());
      return drawn ? std::optional(drawn->wi) : std::nullopt;
    };
    const ChiSquare result =
        sphere_chi_square(SphereGrid(kNormal), sample, [&](const V3f& wi) { return bsdf.eval(wi).pdf; });
    EXPECT_GT(result.p, level) << c.roughness << " " << c.angle;
    EXPECT_EQ(result.impossible, 0);
  }
}

TEST(Glossy, SamplesCarryTheValueOfTheirDirection) {
  const GlossyBsdf bsdf(Rgb(0.4f), 0.3f, 1.5f, kNormal, viewer(0.8f));
  TestRandom random(3);
  for (int i = 0; i < 200; ++i) {
    const auto drawn = bsdf.sample(random.unit3());
    if (!drawn) continue;
    const GlossyValue value = bsdf.eval(drawn->wi);
    EXPECT_NEAR(drawn->value.pdf, value.pdf, 2e-3f * value.pdf);
    EXPECT_NEAR(drawn->value.specular, value.specular, 2e-3f * value.specular + 1e-6f);
  }
}

TEST(Glossy, NeverGivesBackMoreThanItGets) {
  for (const Case& c : kCases) {
    const GlossyBsdf bsdf(Rgb(1), c.roughness, c.ior, kNormal, viewer(c.angle));
    const double albedo = sphere_integral(SphereGrid(kNormal), [&](const V3f& wi) {
      const GlossyValue value = bsdf.eval(wi);
      return value.diffuse.x + value.specular;
    });
    EXPECT_LE(albedo, 1.0);
    EXPECT_GT(albedo, 0.5);
  }
}

// A black base leaves the coat alone, which at normal incidence reflects ((ior - 1) / (ior + 1))^2.
TEST(Glossy, CoatReflectsWhatFresnelSays) {
  const GlossyBsdf bsdf(Rgb(0), 0.2f, 1.5f, kNormal, kNormal);
  TestRandom random(11);
  RunningMean mean;
  for (int i = 0; i < 20000; ++i) {
    const auto drawn = bsdf.sample(random.unit3());
    mean.add(drawn ? drawn->value.specular / drawn->value.pdf : 0);
  }
  EXPECT_NEAR(mean.mean(), 0.04, 0.0005);
}

// f = rho / cos(theta_i) must not change when light and viewer change places.
TEST(Glossy, IsReciprocal) {
  TestRandom random(5);
  for (int i = 0; i < 200; ++i) {
    V3f a = random.direction(), b = random.direction();
    if (a.dot(kNormal) < 0) a = -a;
    if (b.dot(kNormal) < 0) b = -b;
    if (std::min(a.dot(kNormal), b.dot(kNormal)) < 0.05f) continue;
    const GlossyValue ab = GlossyBsdf(Rgb(0.5f), 0.4f, 1.5f, kNormal, a).eval(b);
    const GlossyValue ba = GlossyBsdf(Rgb(0.5f), 0.4f, 1.5f, kNormal, b).eval(a);
    const float f_ab = (ab.diffuse.x + ab.specular) / b.dot(kNormal);
    const float f_ba = (ba.diffuse.x + ba.specular) / a.dot(kNormal);
    EXPECT_NEAR(f_ab, f_ba, 1e-3f * f_ab);
  }
}

}  // namespace
}  // namespace pelage
