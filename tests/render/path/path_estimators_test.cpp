// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "render/light/far_light_samples.h"
#include "tests/geom/random_strands.h"
#include "tests/render/path/path_scene.h"

namespace pelage::path_estimators_test {
namespace {

constexpr int kRuns = 16;

struct Estimate {
  double mean = 0;
  double standard_error = 0;
};

/// Mean luminance of a whole picture over independent seeds.
Estimate estimate(PathScene& scene, const PathOptions& options, int64_t first_seed, int runs = kRuns) {
  double sum = 0, squares = 0;
  for (int run = 0; run < runs; ++run) {
    scene.render.seed = first_seed + run;
    const double mean = luminance(picture_mean(scene.run(options).film).mean);
    sum += mean;
    squares += mean * mean;
  }
  const double mean = sum / runs;
  return {mean, std::sqrt(std::max(0.0, squares / runs - mean * mean) / (runs - 1))};
}

/// Fur on a ball under a small and a large light and a sky: each technique has something it is bad at.
struct FurryScene : PathScene {
  FurryScene() : PathScene(24, 24) {
    RandomStrandOptions o;
    o.strands = 300;
    o.radius = 0.02f;
    o.wander = 0.2f;
    ConeShellParams fibre;
    fibre.color = Field(Rgb(0.9f, 0.8f, 0.6f));
    fibre.diffuse = 0.65f;
    fibre.primary = Rgb(0.3f);
    add_fur(random_strands(9, o), fibre);
    LambertParams skin;
    skin.color = Field(Rgb(0.7f));
    add_skin(sphere_mesh(0.8f), skin);
    RectangleLightParams key;
    key.position = V3f(3, 3, 3);
    key.look_at = V3f(0);
    key.size = V2f(4, 4);
    key.radiance = Rgb(3);
    add_light("key", key);
    SphereLightParams spark;
    spark.position = V3f(-2, 2, 2);
    spark.radius = 0.4f;
    spark.radiance = Rgb(15);
    add_light("spark", spark);
    add_sky(Rgb(0.2f));
    camera.fov = 14.0f;
    render.samples = 32;
  }
};

/// Two-sided level 1e-4 over the three comparisons of a test, by Sidak: |z| < 4.15.
void expect_same(const Estimate& a, const Estimate& b) {
  const double error = std::hypot(a.standard_error, b.standard_error);
  EXPECT_LT(std::abs(a.mean - b.mean) / error, 4.15) << a.mean << " and " << b.mean;
  EXPECT_LT(error, 0.02 * a.mean);
}

TEST(PathEstimators, BothRulesForChoosingLightsAgree) {
  FurryScene scene;
  for (int i = 0; i < 12; ++i) {  // more than are listed: they are in a tree
    PointLightParams lamp;
    lamp.position =
        V3f(4 * std::cos(0.5f * static_cast<float>(i)), 1.5f, 4 * std::sin(0.5f * static_cast<float>(i)));
    lamp.radius = 0.1f;
    lamp.power = 60;
    scene.add_light("lamp" + std::to_string(i), lamp);
  }
  scene.render.bounces = 1;
  PathOptions film;
  film.choice = LightChoice::kImportance;
  expect_same(estimate(scene, film, 0, 8), estimate(scene, {}, 100, 8));
}

TEST(PathEstimators, LightsLobesAndBothAgree) {
  FurryScene scene;
  scene.render.bounces = 1;
  PathOptions both, lights, lobes;
  lights.direct = DirectTechniques::kLightsOnly;
  lobes.direct = DirectTechniques::kLobesOnly;
  const Estimate with_both = estimate(scene, both, 0);
  const Estimate with_lights = estimate(scene, lights, 100);
  const Estimate with_lobes = estimate(scene, lobes, 200);
  expect_same(with_both, with_lights);
  expect_same(with_both, with_lobes);
  expect_same(with_lights, with_lobes);
  EXPECT_LT(with_both.standard_error, 1.2 * with_lobes.standard_error);
}

TEST(PathEstimators, MoreLightSamplesChangeTheNoiseOnly) {
  FurryScene scene;
  scene.render.bounces = 1;
  // Errors of errors: those of 100 runs are known to 7 %, and differ by 15.
  constexpr int kMany = 100;
  const Estimate one = estimate(scene, {}, 500, kMany);
  const int64_t shadow_rays = scene.statistics.rays.shadow;
  scene.render.light_samples = 3;
  const Estimate three = estimate(scene, {}, 600, kMany);
  expect_same(one, three);
  EXPECT_LT(three.standard_error, one.standard_error);
  EXPECT_GT(scene.statistics.rays.shadow, 3 * shadow_rays);
}

/// A room with two lamps.
TEST(PathEstimators, LaterVerticesHaveTwoShadowRays) {
  PathScene scene(16, 16);
  scene.add_skin(sphere_mesh(100), LambertParams{});  // around the camera
  for (const float side : {-4.0f, 4.0f}) {
    SphereLightParams lamp;
    lamp.position = V3f(side, 0, 0);
    lamp.radius = 0.5f;
    lamp.radiance = Rgb(5);
    scene.add_light("lamp", lamp);
  }
  PathOptions options;
  options.direct = DirectTechniques::kLightsOnly;
  scene.render.bounces = 0;
  scene.run(options);
  const auto direct = scene.statistics.rays;
  scene.statistics = {};
  scene.render.bounces = 1;
  scene.run(options);
  const auto all = scene.statistics.rays;
  EXPECT_LE(direct.shadow, direct.camera);
  EXPECT_GT(static_cast<double>(all.shadow - direct.shadow), 1.3 * static_cast<double>(all.indirect));
  EXPECT_LE(all.shadow - direct.shadow, 2 * all.indirect);
}

TEST(PathEstimators, PointsOnFarLightsComeFromTheOptions) {
  PathScene scene(8, 8);
  scene.add_skin(sphere_mesh(1), LambertParams{});
  scene.camera.fov = 4;  // no sample sees the sky itself
  scene.add_sky(Rgb(1));
  scene.render.bounces = 0;
  PathOptions options;
  options.direct = DirectTechniques::kLightsOnly;
  const auto mean = [&] { return luminance(picture_mean(scene.run(options).film).mean); };
  const float usual = mean();
  TextureLibrary textures(scene.ledger);
  EnvironmentLightParams brighter;
  brighter.radiance = Rgb(3);
  std::vector<std::unique_ptr<Light>> lights;
  lights.push_back(make_light("sky", brighter, 1, textures, scene.ledger));
  const LightSet other(std::move(lights));
  const FarLightSamples far_lights(other, 1, true);
  options.far_lights = &far_lights;
  EXPECT_NEAR(mean() / usual, 3, 0.2f);
}

TEST(PathEstimators, RouletteChangesNoMean) {
  FurryScene scene;
  scene.render.bounces = 8;
  PathOptions with, without;
  without.roulette = false;
  const Estimate a = estimate(scene, with, 300);
  const int64_t with_rays = scene.statistics.rays.indirect;
  const Estimate b = estimate(scene, without, 400);
  expect_same(a, b);
  EXPECT_LT(with_rays, scene.statistics.rays.indirect - with_rays);
}

/// A light that is seldom chosen, on a surface so dark that few paths go on: were roulette not counted in the
/// weights, what these few bring back would be nearly all there is of it.
TEST(PathEstimators, DarkSurfacesAreNotLeftToRareRays) {
  PathScene scene(16, 16);
  LambertParams dark;
  dark.color = Field(Rgb(0.02f));
  scene.add_skin(sphere_mesh(0.8f), dark);
  RectangleLightParams strong;
  strong.position = V3f(0, 3, 1);
  strong.look_at = V3f(0);
  strong.size = V2f(4, 4);
  strong.radiance = Rgb(20);
  scene.add_light("strong", strong);
  scene.add_sky(Rgb(1));
  scene.camera.fov = 8.0f;
  scene.render.samples = 32;
  scene.render.bounces = 1;
  PathOptions without;
  without.roulette = false;
  const Estimate a = estimate(scene, {}, 700), b = estimate(scene, without, 800);
  expect_same(a, b);
  EXPECT_LT(a.standard_error, 2 * b.standard_error);
}

/// Opaque fur of half the density would not do: half-transparent strands in front of a lamp dim it by 1 -
/// opacity to the camera and to shadow rays alike.
TEST(PathEstimators, SemiTransparentStrandsDimWhatIsBehind) {
  PathScene scene(16, 16);
  ConeShellParams black = diffuse_fibre(Rgb(0));
  black.opacity = Field(0.3f);
  scene.add_fur(one_strand({{0, -9, 0}, {0, -3, 0}, {0, 3, 0}, {0, 9, 0}}, 0.5f), black);
  scene.add_sky(Rgb(1));
  scene.camera.fov = 1.0f;
  scene.render.samples = 256;
  const FrameResult result = scene.run();
  const PictureMean picture = picture_mean(result.film);
  EXPECT_NEAR(luminance(picture.mean), 0.7, 4 * picture.standard_error + 1e-5);
  EXPECT_NEAR(1 - result.film.alpha(3, 3), luminance(result.film.radiance(3, 3)), 1e-5);
}

}  // namespace
}  // namespace pelage::path_estimators_test
