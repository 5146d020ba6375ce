// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/cone_shell_bsdf.h"

#include <gtest/gtest.h>

#include "tests/render/random.h"
#include "tests/render/sphere_statistics.h"

namespace pelage {
namespace {

constexpr double kPiD = std::numbers::pi;

struct BsdfCase {
  std::string name;
  ConeShellParams params;
  Rgb color{0.5f, 0.3f, 0.15f};
  float theta_o = 0.3f;
  float bend = 0;  ///< angle between the tangents of the lobes

  ConeShellBsdf bsdf() const {
    const LobeTangents tangents{V3f(0, 0, 1), inclined(kPi / 2 - bend, 0.7f),
                                inclined(kPi / 2 - bend, -1.9f)};
    return ConeShellBsdf(ConeShellMaterial(params), color, tangents, inclined(theta_o, 2.1f));
  }
};

std::vector<BsdfCase> bsdf_grid() {
  std::vector<BsdfCase> grid;
  const auto add = [&](std::string name, auto&& change) {
    for (float theta : {0.0f, -0.8f, 1.45f, kPi / 2}) {
      for (ShellVariant variant : {ShellVariant::kWigner, ShellVariant::kLiteral}) {
        BsdfCase c;
        c.name = name + ", theta_o " + std::to_string(theta) +
                 (variant == ShellVariant::kWigner ? ", wigner" : ", literal");
        c.params.variant = variant;
        c.theta_o = theta;
        change(c);
        grid.push_back(c);
      }
    }
  };
  add("default", [](BsdfCase&) {});
  add("bent", [](BsdfCase& c) { c.bend = 0.4f; });
  add("back", [](BsdfCase& c) { c.params.balance = 1; });
  add("forward, tilted", [](BsdfCase& c) {
    c.params.balance = -0.6f;
    c.params.primary_tilt = 8;
    c.params.secondary_tilt = -11;
    c.bend = 0.1f;
  });
  add("bright highlights", [](BsdfCase& c) {
    c.params.primary = Rgb(0.5f, 0.4f, 0.3f);
    c.params.secondary = Rgb(0.9f);
    c.params.diffuse = 0.1f;
    c.params.primary_width = 5;
    c.params.secondary_width = 60;
  });
  return grid;
}

/// An axis that no shell is aligned with, so that midpoints do not fall on edges together.
const V3f kObliqueAxis = V3f(0.36f, 0.48f, 0.8f);

TEST(ConeShellBsdf, PdfIntegratesToOneAndRhoToAlbedo) {
  for (const BsdfCase& c : bsdf_grid()) {
    const ConeShellBsdf bsdf = c.bsdf();
    const SphereGrid grid(kObliqueAxis);
    double rho[3] = {0, 0, 0}, pdf = 0;
    constexpr int kZSteps = 500, kTurnSteps = 1000;
    const double area = sphere_integral(
        grid,
        [&](const V3f& w) {
          const FibreValue value = bsdf.eval(w);
          for (int channel = 0; channel < 3; ++channel) rho[channel] += value.total()[channel];
          pdf += value.pdf;
          return 1.0;
        },
        kZSteps, kTurnSteps);
    const double cell = area / (kZSteps * kTurnSteps);
    EXPECT_NEAR(pdf * cell, 1, 2e-3) << c.name;
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(rho[channel] * cell / bsdf.albedo()[channel], 1, 2e-3) << c.name;
    }
  }
}

TEST(ConeShellBsdf, SamplerPassesChiSquare) {
  const std::vector<BsdfCase> grid = bsdf_grid();
  const double level = sidak_level(1e-3, grid.size());
  uint64_t seed = 100;
  for (const BsdfCase& c : grid) {
    const ConeShellBsdf bsdf = c.bsdf();
    TestRandom random(++seed);
    int missed = 0;
    const ChiSquare test = sphere_chi_square(
        SphereGrid(kObliqueAxis),
        [&](int) -> std::optional<V3f> {
          const std::optional<FibreSample> s = bsdf.sample(random.unit3());
          missed += !s;
          return s ? std::optional<V3f>(s->wi) : std::nullopt;
        },
        [&](const V3f& w) { return bsdf.eval(w).pdf; });
    EXPECT_GT(test.p, level) << c.name << ": " << test.statistic << " / " << test.dof;
    EXPECT_LE(missed, 3) << c.name;
  }
}

TEST(ConeShellBsdf, SamplesAgreeWithEvalAndAverageToAlbedo) {
  const std::vector<BsdfCase> grid = bsdf_grid();
  const double level = sidak_level(1e-3, 3.0 * grid.size());
  for (const BsdfCase& c : grid) {
    const ConeShellBsdf bsdf = c.bsdf();
    TestRandom random(55);
    RunningMean mean[3];
    for (int i = 0; i < 20000; ++i) {
      const std::optional<FibreSample> s = bsdf.sample(random.unit3());
      ASSERT_NEAR(s ? s->wi.length() : 1.0f, 1.0f, 1e-5f);
      const FibreValue value = s ? bsdf.eval(s->wi) : FibreValue{};
      ASSERT_EQ(value.pdf, s ? s->value.pdf : 0.0f);
      for (int channel = 0; channel < 3; ++channel) {
        mean[channel].add(s ? s->value.total()[channel] / s->value.pdf : 0.0f);
      }
    }
    for (int channel = 0; channel < 3; ++channel) {
      const double off = mean[channel].mean() - bsdf.albedo()[channel];
      // Lobes of one colour have constant weights: nothing is left to chance there but rounding.
      if (std::abs(off) < 1e-5) continue;
      EXPECT_GT(normal_tail(off / mean[channel].standard_error()), level) << c.name << " channel " << channel;
    }
  }
}

TEST(ConeShellBsdf, WeightsOfASingleLobeAreConstant) {
  for (ShellVariant variant : {ShellVariant::kWigner, ShellVariant::kLiteral}) {
    for (int lobe = 0; lobe < kLobeGroups; ++lobe) {
      BsdfCase c;
      c.params.variant = variant;
      c.params.balance = 0.5f;
      c.params.diffuse = lobe == 0 ? 0.7f : 0.0f;
      c.params.primary = Rgb(lobe == 1 ? 0.6f : 0.0f);
      c.params.secondary = Rgb(lobe == 2 ? 0.5f : 0.0f);
      const ConeShellBsdf bsdf = c.bsdf();
      TestRandom random(8);
      for (int i = 0; i < 20000; ++i) {
        const std::optional<FibreSample> s = bsdf.sample(random.unit3());
        if (!s) continue;
        const Rgb weight = s->value.total() * (1.0f / s->value.pdf);
        const Rgb albedo = bsdf.albedo();
        for (int channel = 0; channel < 3; ++channel)
          ASSERT_NEAR(weight[channel] / albedo[channel], 1, 2e-6f);
      }
    }
  }
}

TEST(ConeShellBsdf, WhiteFurnace) {
  for (BsdfCase c : bsdf_grid()) {
    c.color = Rgb(1);
    c.params.diffuse = 0.6f;
    c.params.primary = Rgb(0.3f);
    c.params.secondary = Rgb(0.1f);
    const ConeShellBsdf bsdf = c.bsdf();
    for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(bsdf.albedo()[channel], 1, 1e-6);
    EXPECT_NEAR(
        sphere_integral(
            SphereGrid(kObliqueAxis), [&](const V3f& w) { return bsdf.eval(w).total().x; }, 500, 1000),
        1, 2e-3)
        << c.name;
    TestRandom random(77);
    RunningMean mean;
    for (int i = 0; i < 4000; ++i) {
      const std::optional<FibreSample> s = bsdf.sample(random.unit3());
      mean.add(s ? s->value.total().x / s->value.pdf : 0.0f);
    }
    EXPECT_NEAR(mean.mean(), 1, 5e-3 + 4 * mean.standard_error()) << c.name;
  }
}

TEST(ConeShellBsdf, NeverGivesBackMoreThanItGets) {
  BsdfCase c;
  c.color = Rgb(1, 0.5f, 0.2f);
  c.params.diffuse = 1;
  c.params.primary = Rgb(0.5f, 0.5f, 0.1f);
  c.params.secondary = Rgb(1);
  const Rgb albedo = c.bsdf().albedo();
  EXPECT_NEAR(albedo.x, 1, 1e-6);
  EXPECT_NEAR(albedo.y, 1.5 / 2.5,
              1e-6);  // all channels by the same factor, so that colours keep their ratios
  EXPECT_NEAR(albedo.z, 0.5 / 2.5, 1e-6);
}

TEST(ConeShellBsdf, BlackFibresScatterNothing) {
  BsdfCase c;
  c.color = Rgb(0);
  c.params.primary = Rgb(0);
  const ConeShellBsdf bsdf = c.bsdf();
  EXPECT_EQ(bsdf.albedo(), Rgb(0));
  TestRandom random(1);
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(bsdf.sample(random.unit3()));
  EXPECT_EQ(bsdf.eval(random.direction()).pdf, 0);
}

TEST(ConeShellBsdf, DiffuseLobeIsReciprocalAndBalanced) {
  BsdfCase c;
  c.params.balance = 0.8f;
  c.params.diffuse = 0.7f;
  c.params.primary = c.params.secondary = Rgb(0);
  const ConeShellMaterial material(c.params);
  const V3f tangent(0, 0, 1);
  const LobeTangents tangents{tangent, tangent, tangent};
  TestRandom random(6);
  for (int i = 0; i < 1000; ++i) {
    const V3f a = random.direction(), b = random.direction();
    const auto f = [&](const V3f& wo, const V3f& wi) {
      return ConeShellBsdf(material, Rgb(1), tangents, wo).eval(wi).total().x / std::sqrt(1 - wi.z * wi.z);
    };
    const float phi = std::atan2(a.y, a.x) - std::atan2(b.y, b.x);
    EXPECT_NEAR(f(a, b), f(b, a), 1e-5);
    EXPECT_NEAR(f(a, b), 0.7 / (kPiD * kPiD) * (1 + 0.8 * std::cos(phi)), 1e-5);
  }
}

TEST(ConeShellBsdf, JitterBelongsToTheStrand) {
  ConeShellParams params;
  params.primary_shift = -0.03f;
  params.primary_jitter = 0.05f;
  const ConeShellMaterial material(params);
  RunningMean mean;
  for (uint64_t strand = 0; strand < 20000; ++strand) {
    const float place = material.tangent_place(LobeGroup::kPrimary, 0.5f, strand, 3);
    ASSERT_EQ(place, material.tangent_place(LobeGroup::kPrimary, 0.5f, strand, 3));
    ASSERT_GE(place, 0.47f - 0.0501f);
    ASSERT_LE(place, 0.47f + 0.0501f);
    mean.add(place);
  }
  EXPECT_NEAR(mean.mean(), 0.47, 4 * mean.standard_error());
  EXPECT_NEAR(std::sqrt(mean.variance()), 0.05 / std::sqrt(3.0), 3e-4);
  EXPECT_NE(material.tangent_place(LobeGroup::kPrimary, 0.5f, 1, 3) + 0.11f,
            material.tangent_place(LobeGroup::kSecondary, 0.5f, 1, 3));
  EXPECT_NE(material.tangent_place(LobeGroup::kPrimary, 0.5f, 1, 3),
            material.tangent_place(LobeGroup::kPrimary, 0.5f, 1, 4));
  EXPECT_EQ(material.tangent_place(LobeGroup::kDiffuse, 0.25f, 1, 3), 0.25f);
  for (uint64_t strand = 0; strand < 100; ++strand) {
    EXPECT_GE(material.tangent_place(LobeGroup::kPrimary, 0.0f, strand, 3), 0.0f);
    EXPECT_LE(material.tangent_place(LobeGroup::kSecondary, 1.0f, strand, 3), 1.0f);
  }
}

TEST(ConeShellBsdf, ShiftMovesTheHighlightAlongABentStrand) {
  // A strand that bends by 60 degrees; where along it is each highlight brightest for a viewer and a light
  // above?
  const auto brightest = [](float shift, LobeGroup lobe) {
    ConeShellParams params;
    params.primary_shift = params.secondary_shift = shift;
    params.primary_jitter = params.secondary_jitter = 0;
    const ConeShellMaterial material(params);
    const auto tangent = [](float v) { return inclined(0, v * kPi / 3 - kPi / 6); };
    const V3f wo = inclined(0, kPi / 2 + 0.1f), wi = inclined(0, kPi / 2 - 0.1f);
    float best = -1, best_v = 0;
    for (int i = 0; i <= 1000; ++i) {
      const float v = i / 1000.0f;
      LobeTangents tangents;
      for (int l = 0; l < kLobeGroups; ++l) {
        tangents[l] = tangent(material.tangent_place(static_cast<LobeGroup>(l), v, 5, 0));
      }
      const float value =
          ConeShellBsdf(material, Rgb(0.5f), tangents, wo).eval(wi).lobes[static_cast<int>(lobe)].x;
      if (value > best) best = value, best_v = v;
    }
    return best_v;
  };
  for (LobeGroup lobe : {LobeGroup::kPrimary, LobeGroup::kSecondary}) {
    EXPECT_NEAR(brightest(0, lobe), 0.5, 0.02);
    EXPECT_NEAR(brightest(-0.1f, lobe), 0.6, 0.02) << "a negative shift moves it to the tip";
    EXPECT_NEAR(brightest(0.1f, lobe), 0.4, 0.02);
  }
}

TEST(ConeShellBsdf, NarrowestLobesAndPolesStayFinite) {
  TestRandom random(12);
  for (int i = 0; i < 20000; ++i) {
    BsdfCase c;
    c.params.variant = random.unit() < 0.5f ? ShellVariant::kWigner : ShellVariant::kLiteral;
    c.params.primary_width = random.unit() < 0.5f ? 1.0f : random.between(1, 90);
    c.params.secondary_width = random.unit() < 0.5f ? 90.0f : random.between(1, 90);
    c.params.primary_tilt = random.between(-45, 45);
    c.params.balance = random.between(-1, 1);
    c.theta_o =
        random.unit() < 0.3f ? std::copysign(kPi / 2, random.between(-1, 1)) : random.between(-1.6f, 1.6f);
    c.bend = random.unit() < 0.5f ? 0.0f : random.between(0, 0.01f);
    const ConeShellBsdf bsdf = c.bsdf();
    const V3f u = random.unit3();
    const std::optional<FibreSample> s = bsdf.sample(random.unit() < 0.1f ? V3f(u.x, 0, 0) : u);
    if (!s) continue;
    ASSERT_TRUE(std::isfinite(s->value.pdf) && s->value.pdf > 0);
    ASSERT_TRUE(std::isfinite(s->value.total().x));
    ASSERT_NEAR(s->wi.length(), 1, 1e-4f);
    ASSERT_LT(s->value.total().x / s->value.pdf, 20.0f);
  }
}

}  // namespace
}  // namespace pelage
