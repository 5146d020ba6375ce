// SPDX-License-Identifier: Apache-2.0
// render.indirect: dual, against paths of many bounces.
#include <gtest/gtest.h>

#include "tests/render/path/path_scene.h"

namespace pelage::dual_light_test {
namespace {

/// Fur in which light is scattered many times, lit from one side.
void light_fur(PathScene& scene, const Rgb& absorption) {
  ChiangParams fibre;
  fibre.absorption = absorption;
  scene.add_fur(furball(4000, 0.5f, 0.006f), fibre);
  SphereLightParams lamp;
  lamp.position = V3f(4, 4, 6);
  lamp.radiance = Rgb(30);
  scene.add_light("lamp", lamp);
  scene.camera.fov = 20;
  scene.render.samples = 16;
  scene.render.bounces = 16;
}

double mean(const FrameResult& result) {
  double sum = 0;
  for (int y = 0; y < result.film.height(); ++y) {
    for (int x = 0; x < result.film.width(); ++x) sum += luminance(result.film.radiance(x, y));
  }
  return sum;
}

TEST(DualLight, IsNearTheLightOfManyBounces) {
  for (const float absorption : {0.02f, 0.3f, 2.0f}) {
    const auto light = [&](IndirectLight indirect, int bounces) {
      PathScene scene(16, 16);
      light_fur(scene, Rgb(absorption));
      scene.render.indirect = indirect;
      scene.render.bounces = bounces;
      return mean(scene.run());
    };
    const double paths = light(IndirectLight::kPath, 16), direct = light(IndirectLight::kPath, 0);
    const double dual = light(IndirectLight::kDual, 16);
    // docs/lab/DUAL.md has the error by brightness. Dual scattering must find most of the light that direct
    // light lacks, and must not add half as much again.
    EXPECT_GT(dual, direct);
    EXPECT_LT(std::abs(dual - paths), 0.5 * std::abs(direct - paths)) << absorption;
  }
}

TEST(DualLight, IsTheSameForAnyThreads) {
  PathScene scene(16, 16);
  light_fur(scene, Rgb(0.1f));
  scene.render.indirect = IndirectLight::kDual;
  scene.render.samples = 2;
  const FrameResult one = scene.run({}, 1), three = scene.run({}, 3);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) EXPECT_EQ(one.film.radiance(x, y), three.film.radiance(x, y));
  }
}

}  // namespace
}  // namespace pelage::dual_light_test
