// SPDX-License-Identifier: Apache-2.0
#include "render/light/direct_light.h"

#include <gtest/gtest.h>

#include "render/fibre/cone_shell_bsdf.h"
#include "render/light/environment_light.h"
#include "render/light/light_set.h"
#include "render/light/rectangle_light.h"
#include "render/light/sphere_light.h"
#include "render/sampling/sample_stream.h"
#include "tests/render/random.h"
#include "tests/support/chi_square.h"

namespace pelage {
namespace {

using Lights = std::vector<std::unique_ptr<Light>>;

std::unique_ptr<Light> rectangle(float half_size, bool two_sided = false) {
  Rectangle shape;
  shape.center = {1.5f, 1, 2};
  const V3f normal = -shape.center.normalized();
  complete_frame(normal, shape.x, shape.y);
  shape.half_size = {half_size, 0.6f * half_size};
  return std::make_unique<RectangleLight>("rectangle", shape, Rgb(1.0f / (half_size * half_size)), two_sided,
                                          false);
}

std::unique_ptr<Light> sphere(float radius) {
  return std::make_unique<SphereLight>("sphere", V3f(-1, 2, -0.7f), radius, Rgb(1.0f / (radius * radius)),
                                       false);
}

/// A dim gradient, a soft patch and a sun.
std::unique_ptr<Light> sky() {
  static MemoryLedger ledger;
  Image image{64, 32, 3, std::vector<float>(64 * 32 * 3)};
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      const float patch = std::exp(-0.05f * static_cast<float>((x - 20) * (x - 20) + (y - 18) * (y - 18)));
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = 0.02f + 0.01f * static_cast<float>(32 - y) + 2 * patch;
    }
  }
  for (int y = 7; y < 13; ++y) {
    for (int x = 40; x < 46; ++x) std::fill_n(image.at(x, y), 3, 15.0f);
  }
  return std::make_unique<EnvironmentLight>("sky", std::make_shared<const Texture>(std::move(image)), Rgb(1),
                                            rotation_xyz({10, 50, 0}), false, ledger);
}

struct Scene {
  std::string name;
  LightSet lights;
  bool furnace = false;  ///< equally bright in all directions
};

/// No light is so small that lobe samples hardly ever hit it: without hits there is no standard error to test
/// with.
std::vector<Scene> scenes() {
  std::vector<Scene> result;
  const auto add = [&](std::string name, auto... light) {
    Lights lights;
    (lights.push_back(std::move(light)), ...);
    result.push_back({std::move(name), LightSet(std::move(lights))});
  };
  add("small rectangle", rectangle(0.3f));
  add("large rectangle", rectangle(2.0f));
  add("two-sided rectangle", rectangle(0.7f, true));
  add("small sphere", sphere(0.25f));
  add("large sphere", sphere(1.5f));
  add("all round", sphere(4.0f));
  add("constant sky", std::unique_ptr<Light>(std::make_unique<EnvironmentLight>("sky", Rgb(0.7f), false)));
  result[result.size() - 1].furnace = result[result.size() - 2].furnace = true;
  add("sky with a sun", sky());
  add("everything", rectangle(0.4f), sphere(0.3f), sky());
  return result;
}

struct Fibre {
  std::string name;
  ConeShellBsdf bsdf;
};

std::vector<Fibre> fibres() {
  std::vector<Fibre> result;
  const V3f tangent = V3f(0.2f, 1, 0.1f).normalized(), wo = V3f(0.3f, 0.4f, 1).normalized();
  for (ShellVariant variant : {ShellVariant::kWigner, ShellVariant::kLiteral}) {
    for (float width : {3.0f, 12.0f, 60.0f}) {
      ConeShellParams params;
      params.variant = variant;
      params.primary_width = width;
      params.primary = Rgb(0.4f);
      params.diffuse = 0.3f;
      params.balance = 0.4f;
      const V3f bent = (tangent + V3f(0.1f, 0, -0.2f)).normalized();
      result.push_back(
          {std::string(variant == ShellVariant::kWigner ? "wigner " : "literal ") + std::to_string(width),
           ConeShellBsdf(ConeShellMaterial(params), Rgb(0.6f, 0.5f, 0.4f), {tangent, bent, tangent}, wo)});
    }
  }
  return result;
}

const V3f kFrom(0.1f, -0.2f, 0.3f);

std::vector<float> probabilities(const LightSet& lights) {
  std::vector<float> p(lights.size());
  lights.probabilities(kFrom, p);
  return p;
}

/// Light through a light sample; weighted against the lobes when `mis`.
double by_light(const Scene& scene, const Fibre& fibre, const V2f& u, bool mis) {
  const LightSet::Choice choice = LightSet::choose(probabilities(scene.lights), u.x);
  if (!(choice.probability > 0)) return 0;
  const std::optional<LightSample> s = scene.lights.light(choice.light).sample(kFrom, {choice.remapped, u.y});
  if (!s) return 0;
  const FibreValue value = fibre.bsdf.eval(s->direction);
  const float pdf = s->pdf * choice.probability;
  return luminance(value.total() * s->radiance) / pdf * (mis ? power_weight(pdf, value.pdf) : 1.0f);
}

/// Light through a sample of the lobes.
double by_lobe(const Scene& scene, const Fibre& fibre, const V3f& u, bool mis) {
  const std::optional<FibreSample> s = fibre.bsdf.sample(u);
  if (!s) return 0;
  double sum = 0;
  for (size_t k = 0; k < scene.lights.size(); ++k) {
    const Light& light = scene.lights.light(k);
    const std::optional<LightHit> hit = light.intersect(kFrom, s->wi);
    if (!hit) continue;
    const float pdf = light.pdf(kFrom, s->wi) * probabilities(scene.lights)[k];
    sum += luminance(s->value.total() * hit->radiance) / s->value.pdf *
           (mis ? power_weight(s->value.pdf, pdf) : 1.0f);
  }
  return sum;
}

TEST(DirectLight, LightLobeAndMisEstimatesAgree) {
  const std::vector<Scene> all_scenes = scenes();
  const std::vector<Fibre> all_fibres = fibres();
  const double level = sidak_level(1e-3, 2.0 * all_scenes.size() * all_fibres.size());
  for (const Scene& scene : all_scenes) {
    for (const Fibre& fibre : all_fibres) {
      RunningMean light, lobe, mis;
      TestRandom random(17);
      for (int i = 0; i < 20000; ++i) {
        light.add(by_light(scene, fibre, random.unit2(), false));
        lobe.add(by_lobe(scene, fibre, random.unit3(), false));
        mis.add(by_light(scene, fibre, random.unit2(), true) + by_lobe(scene, fibre, random.unit3(), true));
      }
      const auto z = [](const RunningMean& a, const RunningMean& b) {
        return (a.mean() - b.mean()) / std::hypot(a.standard_error(), b.standard_error());
      };
      // Estimators without any variance (a furnace) agree to rounding instead.
      const double rounding = 1e-5 * mis.mean();
      const std::string where = scene.name + ", " + fibre.name;
      if (std::abs(light.mean() - mis.mean()) > rounding) {
        EXPECT_GT(normal_tail(z(light, mis)), level)
            << where << ": light " << light.mean() << " mis " << mis.mean();
      }
      if (std::abs(lobe.mean() - mis.mean()) > rounding) {
        EXPECT_GT(normal_tail(z(lobe, mis)), level)
            << where << ": lobe " << lobe.mean() << " mis " << mis.mean();
      }
      // Where all directions are equally bright lobe samples have no variance at all; there only the bound of
      // [Veach97, theorem 9.2] can hold for the combination.
      const double best = std::min(light.variance(), lobe.variance());
      EXPECT_LT(mis.variance(), scene.furnace ? best + 0.5 * mis.mean() * mis.mean() : 1.2 * best) << where;
      EXPECT_GT(mis.mean(), 0) << where;
    }
  }
}

TEST(DirectLight, ConstantSurroundingsGiveTheAlbedo) {
  // A sphere around the point and a constant sky are both white furnaces.
  Lights round, sky_only;
  round.push_back(std::make_unique<SphereLight>("sphere", V3f(0), 3.0f, Rgb(1), false));
  sky_only.push_back(std::make_unique<EnvironmentLight>("sky", Rgb(1), false));
  const Scene furnaces[] = {{"sphere", LightSet(std::move(round))}, {"sky", LightSet(std::move(sky_only))}};
  for (const Scene& scene : furnaces) {
    for (const Fibre& fibre : fibres()) {
      const double albedo = luminance(fibre.bsdf.albedo());
      RunningMean light, lobe;
      TestRandom random(23);
      for (int i = 0; i < 20000; ++i) {
        light.add(by_light(scene, fibre, random.unit2(), false));
        lobe.add(by_lobe(scene, fibre, random.unit3(), false));
      }
      EXPECT_NEAR(light.mean(), albedo, 4.5 * light.standard_error()) << scene.name << " " << fibre.name;
      EXPECT_NEAR(lobe.mean(), albedo, 4.5 * lobe.standard_error() + 1e-4) << scene.name << " " << fibre.name;
    }
  }
}

TEST(DirectLight, StreamsConvergeFasterThanRandomNumbers) {
  // The estimator that rendering uses, at 64 samples per pixel, over 200 pixels.
  const std::vector<Scene> all_scenes = scenes();
  const std::vector<Fibre> all_fibres = fibres();
  const Scene& scene = all_scenes.back();
  const Fibre& fibre = all_fibres[1];
  RunningMean clever, plain;
  TestRandom random(5);
  for (uint32_t pixel = 0; pixel < 200; ++pixel) {
    double a = 0, b = 0;
    for (uint32_t s = 0; s < 64; ++s) {
      SampleStream stream(1, pixel, 0, s);
      a += by_light(scene, fibre, stream.next2d(), true);
      a += by_lobe(scene, fibre, stream.next3d(), true);
      b += by_light(scene, fibre, random.unit2(), true) + by_lobe(scene, fibre, random.unit3(), true);
    }
    clever.add(a / 64);
    plain.add(b / 64);
  }
  EXPECT_GT(normal_tail((clever.mean() - plain.mean()) /
                        std::hypot(clever.standard_error(), plain.standard_error())),
            1e-3);
  EXPECT_LT(clever.variance(), 0.5 * plain.variance());
}

TEST(Mis, WeightsOfTwoTechniquesSumToOne) {
  TestRandom random(1);
  for (int i = 0; i < 1000; ++i) {
    const float a = std::pow(10.0f, random.between(-20, 20)), b = std::pow(10.0f, random.between(-20, 20));
    EXPECT_NEAR(balance_weight(a, b) + balance_weight(b, a), 1, 1e-6);
    EXPECT_NEAR(power_weight(a, b) + power_weight(b, a), 1, 1e-6);
  }
  EXPECT_EQ(power_weight(3, 0), 1);
  EXPECT_EQ(power_weight(0, 3), 0);
  EXPECT_EQ(balance_weight(0, 0), 0);
  EXPECT_FLOAT_EQ(power_weight(2, 1), 0.8f);
  EXPECT_FLOAT_EQ(balance_weight(3, 1), 0.75f);
}

}  // namespace
}  // namespace pelage
