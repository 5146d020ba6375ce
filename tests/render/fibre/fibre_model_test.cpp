// SPDX-License-Identifier: Apache-2.0
// What must hold for every model of a fibre.
#include <gtest/gtest.h>

#include "tests/render/fibre/fibre_models.h"

namespace pelage::fibre_model_test {
namespace {

struct Variation {
  std::string name;
  MaterialParams params;
  bool exact_albedo = true;
  int steps = 1;
};

template <class P, class Change>
P changed(Change&& change) {
  P params;
  change(params);
  return params;
}

std::vector<Variation> variations() {
  std::vector<Variation> all;
  all.push_back({"lambert-cylinder", changed<LambertCylinderParams>([](auto& p) { p.albedo = Rgb(0.5f); })});
  for (float exponent : {1.0f, 40.0f, 1000.0f}) {
    all.push_back({"kajiya-kay " + std::to_string(exponent),
                   changed<KajiyaKayParams>([&](auto& p) { p.exponent = exponent, p.diffuse = 0.7f; })});
  }
  for (float beta : {0.1f, 0.3f, 0.6f, 1.0f}) {
    all.push_back({"chiang " + std::to_string(beta), changed<ChiangParams>([&](auto& p) {
                     p.beta_m = p.beta_n = beta;
                     p.alpha = beta > 0.5f ? 8.0f : 2.0f;
                   }),
                   true, beta < 0.2f ? 2 : 1});
  }
  for (float beta : {4.0f, 10.0f, 40.0f}) {
    all.push_back({"deon " + std::to_string(beta), changed<DeonParams>([&](auto& p) {
                     p.beta = beta;
                     p.azimuthal_width = 2 * beta;
                   }),
                   true, beta < 5 ? 3 : 1});
    all.push_back({"marschner " + std::to_string(beta), changed<MarschnerParams>([&](auto& p) {
                     p.beta = 0.5f * beta;
                     p.azimuthal_width = 1.4f * beta;
                     p.variant = MarschnerVariant::kPublished;
                     p.absorption = Rgb(0.05f);
                   }),
                   false, beta < 5 ? 3 : 1});
  }
  for (YanPreset preset : {YanPreset::kNone, YanPreset::kRowA, YanPreset::kRowB}) {
    const auto medulla = [&](auto& p) {
      p.preset = preset;
      p.sigma_ca = p.sigma_ma = Rgb(0.05f, 0.2f, 0.4f);
      if (preset == YanPreset::kRowB) p.alpha = 8, p.beta_m = 20, p.beta_n = 40;
    };
    const std::string name = std::to_string(static_cast<int>(preset));
    all.push_back({"yan-fast " + name, changed<YanFastParams>(medulla), true, 2});
    auto yan = changed<YanParams>(medulla);
    yan.made = MedullaTables::make(yan.optics(), Workers(2), 500);
    all.push_back({"yan " + name, yan, true, 2});
  }
  return all;
}

struct Case : Variation {
  FibrePoint point;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> made = [] {
    std::vector<Case> all;
    for (const Variation& v : variations()) {
      int i = 0;
      for (float theta : {0.0f, -0.7f, 1.35f}) {
        const float h = std::array{0.3f, -0.85f, 0.6f}[i++];
        Case c{v, fibre_point_at(theta, h)};
        c.name += ", theta_o " + std::to_string(theta) + ", h " + std::to_string(h);
        all.push_back(std::move(c));
      }
    }
    return all;
  }();
  return made;
}

/// No lobe is aligned with it: midpoints do not fall on edges together, and poles are like any other place.
const SphereGrid& oblique() {
  static const SphereGrid grid(V3f(0.48f, -0.64f, 0.6f));
  return grid;
}

TEST(FibreModels, PdfIntegratesToOneAndRhoToAlbedo) {
  for (const Case& c : cases()) {
    const FibreMaterial material(c.params);
    const FibreBsdf bsdf = material.at(c.point);
    double rho = 0;
    const double pdf = sphere_integral(
        oblique(),
        [&](const V3f& w) {
          const FibreValue value = bsdf.eval(w);
          rho += value.total().y;
          return value.pdf;
        },
        256 * c.steps, 256 * c.steps);
    rho *= 4 * std::numbers::pi / (256.0 * 256 * c.steps * c.steps);
    EXPECT_NEAR(pdf, 1, 2e-3) << c.name;
    if (c.exact_albedo) {
      EXPECT_NEAR(rho / bsdf.albedo().y, 1, 2e-3) << c.name;
    }
  }
}

TEST(FibreModels, SamplersPassChiSquare) {
  const std::vector<Case>& all = cases();
  const double level = sidak_level(1e-3, all.size());
  uint64_t seed = 700;
  for (const Case& c : all) {
    const FibreMaterial material(c.params);
    const FibreBsdf bsdf = material.at(c.point);
    TestRandom random(++seed);
    SphereTestSize size;
    size.samples = 50000;
    size.z_cells = 30;
    size.turn_cells = 60;
    size.z_steps = size.turn_steps = 6 * c.steps;
    const ChiSquare test = sphere_chi_square(
        oblique(),
        [&](int) -> std::optional<V3f> {
          const std::optional<FibreSample> s = bsdf.sample(random.unit3());
          return s ? std::optional<V3f>(s->wi) : std::nullopt;
        },
        [&](const V3f& w) { return bsdf.eval(w).pdf; }, size);
    EXPECT_GT(test.p, level) << c.name << ": " << test.statistic << " / " << test.dof;
  }
}

TEST(FibreModels, SamplesAgreeWithEvalAndAverageToAlbedo) {
  const std::vector<Case>& all = cases();
  const double level = sidak_level(1e-3, 3.0 * all.size());
  for (const Case& c : all) {
    const FibreMaterial material(c.params);
    const FibreBsdf bsdf = material.at(c.point);
    TestRandom random(56);
    RunningMean mean[3];
    for (int i = 0; i < 10000; ++i) {
      const std::optional<FibreSample> s = bsdf.sample(random.unit3());
      ASSERT_NEAR(s ? s->wi.length() : 1.0f, 1.0f, 1e-5f);
      ASSERT_EQ(s ? bsdf.eval(s->wi).pdf : 0.0f, s ? s->value.pdf : 0.0f);
      for (int k = 0; k < 3; ++k) mean[k].add(s ? s->value.total()[k] / s->value.pdf : 0.0f);
    }
    if (!c.exact_albedo) continue;
    for (int k = 0; k < 3; ++k) {
      const double off = mean[k].mean() - bsdf.albedo()[k];
      if (std::abs(off) < 1e-5) continue;
      EXPECT_GT(normal_tail(off / mean[k].standard_error()), level) << c.name << " channel " << k;
    }
  }
}

TEST(FibreModels, WhiteFibresGiveBackWhatTheyGet) {
  for (Case c : cases()) {
    c.point.color = Rgb(1);
    if (auto* p = std::get_if<LambertCylinderParams>(&c.params)) p->albedo = Rgb(1);
    if (auto* p = std::get_if<KajiyaKayParams>(&c.params)) p->diffuse = 0.5f, p->specular = Rgb(0.5f);
    const auto clear = [](auto* p) {
      if (p) p->sigma_ca = p->sigma_ma = Rgb(0);
    };
    clear(std::get_if<YanFastParams>(&c.params));
    clear(std::get_if<YanParams>(&c.params));
    const FibreMaterial material(c.params);
    const FibreBsdf bsdf = material.at(c.point);
    TestRandom random(91);
    RunningMean mean;
    for (int i = 0; i < 4000; ++i) {
      const std::optional<FibreSample> s = bsdf.sample(random.unit3());
      mean.add(s ? s->value.total().y / s->value.pdf : 0.0f);
    }
    if (c.exact_albedo) {
      EXPECT_NEAR(bsdf.albedo().y, 1, 1e-5) << c.name;
      EXPECT_NEAR(mean.mean(), 1, 1e-4 + 4 * mean.standard_error()) << c.name;
    }
  }
}

/// Narrowest lobes, glancing views, fibres met at their rim: everything stays finite.
TEST(FibreModels, ExtremesStayFinite) {
  std::vector<MaterialParams> extremes;
  extremes.push_back(changed<ChiangParams>([](auto& p) { p.beta_m = p.beta_n = 0.02f; }));
  extremes.push_back(changed<ChiangParams>([](auto& p) { p.eta = 3, p.alpha = -10; }));
  extremes.push_back(changed<DeonParams>([](auto& p) { p.beta = p.azimuthal_width = 0.1f; }));
  extremes.push_back(
      changed<MarschnerParams>([](auto& p) { p.beta = p.azimuthal_width = 0.5f, p.absorption = Rgb(0.1f); }));
  extremes.push_back(changed<KajiyaKayParams>([](auto& p) { p.exponent = 1000, p.diffuse = 0.5f; }));
  extremes.push_back(changed<LambertCylinderParams>([](auto& p) { p.albedo = Rgb(1); }));
  extremes.push_back(changed<YanFastParams>(
      [](auto& p) { p.kappa = 0, p.sigma_ms = 40, p.sigma_ca = p.sigma_ma = Rgb(0, 1, 9); }));
  extremes.push_back(changed<YanFastParams>(
      [](auto& p) { p.preset = YanPreset::kTigerBlack, p.kappa = 0.98f, p.sigma_ms = 40, p.g = -0.9f; }));
  YanParams thick;
  thick.kappa = 0.98f;
  thick.layers = 10;
  thick.sigma_ca = thick.sigma_ma = Rgb(0.1f);
  thick.made = MedullaTables::make(thick.optics(), Workers(2), 50);
  extremes.push_back(thick);
  for (const MaterialParams& params : extremes) {
    const FibreMaterial material(params);
    TestRandom random(13);
    for (int i = 0; i < 4000; ++i) {
      const float h = i % 3 == 0 ? std::copysign(1.0f, random.unit() - 0.5f) : random.between(-1, 1);
      const float theta =
          i % 5 == 0 ? std::copysign(kPi / 2, random.unit() - 0.5f) : random.between(-1.57f, 1.57f);
      const float grey = i % 7 == 0 ? 0.0f : random.unit();
      const FibreBsdf bsdf = material.at(fibre_point_at(theta, h, Rgb(grey, 1, 0.5f)));
      const V3f u = random.unit3();
      const std::optional<FibreSample> s = bsdf.sample(i % 11 == 0 ? V3f(0, 0, u.z) : u);
      const FibreValue value = bsdf.eval(random.direction());
      ASSERT_TRUE(std::isfinite(value.pdf) && std::isfinite(value.total().x));
      ASSERT_GE(value.pdf, 0);
      if (!s) continue;
      ASSERT_TRUE(std::isfinite(s->value.pdf) && s->value.pdf > 0);
      ASSERT_TRUE(std::isfinite(s->value.total().x));
      ASSERT_NEAR(s->wi.length(), 1, 1e-4f);
    }
  }
}

/// R mirrors wo in the normal at h: a sign error would mirror it in the fibre's middle, unseen where
/// everything is symmetric.
TEST(FibreModels, ReflectionIsTheMirrorImageInTheNormalOfTheHit) {
  ChiangParams params;
  params.beta_m = params.beta_n = 0.05f;
  params.alpha = 0;
  params.absorption = Rgb(100);  // nothing comes through
  const FibreMaterial material(params);
  for (float h : {-0.7f, -0.2f, 0.5f}) {
    const FibrePoint point = fibre_point_at(0.3f, h);
    const FibreFrame frame(point.tangents[0], point.wo);
    const V3f normal = frame.to_world({0, std::sqrt(1 - h * h), -h});
    const V3f mirror = 2 * normal.dot(point.wo) * normal - point.wo;
    const FibreBsdf bsdf = material.at(point);
    TestRandom random(4);
    V3f mean(0);
    for (int i = 0; i < 2000; ++i) mean += bsdf.sample(random.unit3())->wi;
    EXPECT_LT((mean.normalized() - mirror).length(), 0.01f) << h;
  }
}

/// With T from root to tip the cuticle's tilt leans R to the root, which moves the highlight along the strand
/// to the tip, and TRT the other way.
TEST(FibreModels, TheCuticleLeansTheHighlightsApart) {
  const auto peak = [](const MaterialParams& params, LobeGroup group, float h) {
    const FibreMaterial material(params);
    const FibrePoint point = fibre_point_at(0.2f, h, Rgb(1));
    const FibreBsdf bsdf = material.at(point);
    float best = -1, at = 0;
    for (int i = -600; i <= 600; ++i) {
      const float theta = static_cast<float>(i) * 0.001f;
      FibreValue value = bsdf.eval(fibre_direction(point, theta, 0));
      if (value[group].x > best) best = value[group].x, at = theta;
    }
    return at;
  };
  const auto chiang = changed<ChiangParams>([](auto& p) { p.beta_m = 0.15f, p.alpha = 3; });
  const auto deon = changed<DeonParams>([](auto& p) { p.beta = 4, p.alpha = -3; });
  const auto marschner =
      changed<MarschnerParams>([](auto& p) { p.beta = 2, p.alpha = -3, p.absorption = Rgb(0); });
  const auto yan =
      changed<YanFastParams>([](auto& p) { p.beta_m = 4, p.alpha = 3, p.sigma_ca = p.sigma_ma = Rgb(0); });
  const float a = 3 * kPi / 180;
  for (const MaterialParams& params :
       {MaterialParams(chiang), MaterialParams(deon), MaterialParams(marschner), MaterialParams(yan)}) {
    EXPECT_NEAR(peak(params, LobeGroup::kPrimary, 0), -0.2f - 2 * a, 0.02f);
    EXPECT_GT(peak(params, LobeGroup::kSecondary, 0), -0.2f + 2 * a);
  }
}

TEST(FibreModels, PigmentsAddToAbsorptionAndColorStepsBack) {
  const ColorToAbsorption by_color(0.3f);
  AbsorptionParams params;
  EXPECT_EQ(fibre_absorption(params, by_color, Rgb(0.5f)), by_color(Rgb(0.5f)));
  params.preset = HairPreset::kHumanBrown;
  EXPECT_NEAR(fibre_absorption(params, by_color, Rgb(0.5f)).y, 1.3f * 0.697f, 1e-5);
  params.preset = HairPreset::kPolarBear;
  EXPECT_EQ(fibre_absorption(params, by_color, Rgb(0.5f)), Rgb(0));
  params.preset = HairPreset::kHumanBrown;
  params.eumelanin = 1.0f;
  params.pheomelanin = 2.0f;
  EXPECT_NEAR(fibre_absorption(params, by_color, Rgb(0.5f)).z, 1.37f + 2.1f, 1e-5);
  params.absorption = Rgb(1, 2, 3);
  EXPECT_NEAR(fibre_absorption(params, by_color, Rgb(0.5f)).y, 2 + 0.697f + 0.8f, 1e-5);
}

}  // namespace
}  // namespace pelage::fibre_model_test
