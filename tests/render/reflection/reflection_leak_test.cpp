// SPDX-License-Identifier: Apache-2.0
// Whether light leaks into the dark where the reflection cache and patches share it.
#include <cmath>

#include <gtest/gtest.h>

#include "render/sampling/pixel_moments.h"
#include "tests/render/reflection/leak_scenes.h"

namespace pelage::reflection_leak_test {
namespace {

double mean_luminance(const Film& film, const PixelBox& box) {
  double sum = 0;
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) sum += luminance(film.radiance(x, y));
  }
  return sum / ((box.x1 - box.x0) * (box.y1 - box.y0));
}

struct Regions {
  PixelMoments lit, dark;
};

Regions render(LeakScene& scene, Integrator integrator, int first_seed) {
  constexpr int kSeeds = 4;
  scene.render.integrator = integrator;
  Regions regions;
  for (int seed = first_seed; seed < first_seed + kSeeds; ++seed) {
    scene.render.seed = seed;
    const FrameResult result = scene.run();
    regions.lit.add(mean_luminance(result.film, scene.lit));
    regions.dark.add(mean_luminance(result.film, scene.dark));
  }
  return regions;
}

/// No more than `blur` of the lit region's light may reach the dark one on top of what `path` has there,
/// apart from noise: five standard errors (of Student's t with 6 degrees of freedom: chance exceeds them in
/// one of 400 comparisons).
template <class Scene>
void expect_no_leak(double blur) {
  Scene scene;
  const Regions traced = render(scene, Integrator::kPath, 1000);
  const Regions gathered = render(scene, Integrator::kGather, 0);
  EXPECT_GT(scene.statistics.reflections.found, scene.statistics.reflections.lookups / 2);
  EXPECT_LT(traced.dark.mean, 0.3 * traced.lit.mean);
  const double noise = 5 * std::hypot(gathered.dark.error(), traced.dark.error());
  EXPECT_NEAR(gathered.dark.mean, traced.dark.mean, noise + blur * traced.lit.mean);
  EXPECT_LT(noise, 0.03 * traced.lit.mean);
}

/// The blur within cells moves 0.1 % of the light here.
constexpr double kLittle = 0.003;
/// Cells of the walls reach 8 pixels below the rim of the hole, which is lit. From there, light reaches the
/// bottom: 1 % of the light outside.
constexpr double kBelowTheRim = 0.02;

TEST(ReflectionLeaks, NotThroughAThinEar) { expect_no_leak<ThinEar>(kLittle); }
TEST(ReflectionLeaks, NotAlongHairThroughSkin) { expect_no_leak<HairThroughSkin>(kLittle); }
TEST(ReflectionLeaks, NotFromAWhiteCoatToABlackOne) { expect_no_leak<TwoCoats>(kLittle); }
TEST(ReflectionLeaks, NotIntoAHole) { expect_no_leak<StrandInAHole>(kBelowTheRim); }

}  // namespace
}  // namespace pelage::reflection_leak_test
