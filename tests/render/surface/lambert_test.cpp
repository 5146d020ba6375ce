// SPDX-License-Identifier: Apache-2.0
#include "render/surface/lambert.h"

#include <gtest/gtest.h>

#include "render/surface/glossy.h"
#include "tests/render/random.h"
#include "tests/render/sphere_statistics.h"

namespace pelage {
namespace {

const V3f kNormal = V3f(0.48f, -0.6f, 0.64f);

TEST(Lambert, DrawsItsCosineWithConstantWeight) {
  const LambertBsdf bsdf(Rgb(0.8f, 0.5f, 0.1f), kNormal);
  TestRandom random(1);
  const ChiSquare test = sphere_chi_square(
      SphereGrid(kNormal),
      [&](int) -> std::optional<V3f> {
        const std::optional<SurfaceSample> s = bsdf.sample(random.unit2());
        if (!s) return std::nullopt;
        EXPECT_NEAR(s->value.rho.x / s->value.pdf, 0.8f, 1e-6f);
        EXPECT_NEAR(bsdf.eval(s->wi).pdf, s->value.pdf, 1e-6f);
        EXPECT_GE(s->wi.dot(kNormal), 0.0f);
        return s->wi;
      },
      [&](const V3f& w) { return bsdf.eval(w).pdf; });
  EXPECT_GT(test.p, 1e-4) << test.statistic << " / " << test.dof;
  EXPECT_NEAR(sphere_integral(SphereGrid(kNormal), [&](const V3f& w) { return bsdf.eval(w).rho.y; }), 0.5,
              1e-4);
  EXPECT_EQ(bsdf.eval(-kNormal).rho, Rgb(0));
  EXPECT_FLOAT_EQ(bsdf.eval(kNormal).rho.x, 0.8f / kPi);
}

TEST(Warp, DiskKeepsAreas) {
  std::vector<double> observed(64, 0.0);
  TestRandom random(2);
  for (int i = 0; i < 64000; ++i) {
    const V2f p = concentric_disk(random.unit2());
    ASSERT_LE(p.length2(), 1.0f + 1e-6f);
    const int ring = std::min(static_cast<int>(p.length2() * 8), 7);
    const int sector = std::min(static_cast<int>((std::atan2(p.y, p.x) / (2 * kPi) + 0.5f) * 8), 7);
    observed[ring * 8 + sector] += 1;
  }
  EXPECT_GT(chi_square(observed, std::vector<double>(64, 1000.0)).p, 1e-4);
}

TEST(Warp, FramesAreOrthonormal) {
  TestRandom random(3);
  for (int i = 0; i < 5000; ++i) {
    const V3f n = i < 2 ? V3f(0, 0, i ? -1.0f : 1.0f) : random.direction();
    V3f x, y;
    complete_frame(n, x, y);
    ASSERT_NEAR(x.length(), 1, 1e-5f);
    ASSERT_NEAR(y.length(), 1, 1e-5f);
    ASSERT_NEAR(x.cross(y).dot(n), 1, 1e-5f);
  }
}

V3f at(float cosine, float phi) {
  const SphereGrid grid(kNormal);
  return grid.direction(cosine, phi);
}

TEST(Glossy, SamplerPassesChiSquare) {
  const struct {
    float roughness, cosine;
  } cases[] = {{0.3f, 0.9f}, {0.3f, 0.1f}, {0.6f, 0.5f}, {1.0f, 1.0f}, {1.0f, 0.02f}, {0.45f, 0.3f}};
  const double level = sidak_level(1e-3, std::size(cases));
  for (const auto& c : cases) {
    const GlossyBsdf bsdf(Rgb(0.4f), c.roughness, 1.5f, kNormal, at(c.cosine, 0.2f));
    TestRandom random(4);
    SphereTestSize size;
    size.z_steps = size.turn_steps = 24;
    const ChiSquare test = sphere_chi_square(
        SphereGrid(kNormal),
        [&](int) -> std::optional<V3f> {
          const std::optional<GlossySample> s = bsdf.sample(random.unit3());
          return s ? std::optional<V3f>(s->wi) : std::nullopt;
        },
        [&](const V3f& w) { return bsdf.eval(w).pdf; }, size);
    EXPECT_GT(test.p, level) << "roughness " << c.roughness << " cos " << c.cosine << ": " << test.statistic
                             << " / " << test.dof;
  }
}

TEST(Glossy, IsReciprocalAndKeepsEnergy) {
  TestRandom random(5);
  for (int i = 0; i < 300; ++i) {
    const float roughness = random.between(0.05f, 1);
    const V3f a = at(random.between(0.05f, 1), random.unit()),
              b = at(random.between(0.05f, 1), random.unit());
    const auto f = [&](const V3f& wo, const V3f& wi) {
      const GlossyValue value = GlossyBsdf(Rgb(0.4f), roughness, 1.5f, kNormal, wo).eval(wi);
      return (value.diffuse.x + value.specular) / wi.dot(kNormal);
    };
    EXPECT_NEAR(f(a, b), f(b, a), 2e-4f * f(a, b) + 1e-6f);
  }
  for (float roughness : {0.2f, 0.5f, 1.0f}) {
    for (float cosine : {0.05f, 0.4f, 1.0f}) {
      const GlossyBsdf bsdf(Rgb(1), roughness, 1.5f, kNormal, at(cosine, 0.2f));
      const double sum = sphere_integral(SphereGrid(V3f(0.36f, 0.48f, 0.8f)), [&](const V3f& w) {
        const GlossyValue value = bsdf.eval(w);
        return value.diffuse.x + value.specular;
      });
      EXPECT_LT(sum, 1.001) << roughness << " " << cosine;
      // Light that bounces between facets is lost: the more, the rougher and the flatter the view.
      EXPECT_GT(sum, cosine > 0.3f ? 0.6 : 0.2) << roughness << " " << cosine;
      RunningMean mean;
      for (int i = 0; i < 20000; ++i) {
        const std::optional<GlossySample> s = bsdf.sample(random.unit3());
        mean.add(s ? (s->value.diffuse.x + s->value.specular) / s->value.pdf : 0.0f);
      }
      EXPECT_NEAR(mean.mean(), sum, 4.5 * mean.standard_error() + 1e-3) << roughness << " " << cosine;
    }
  }
}

}  // namespace
}  // namespace pelage
