// SPDX-License-Identifier: Apache-2.0
// render.clamp_indirect takes light away where it says, and says how much.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/render/path/path_scene.h"

namespace pelage {
namespace {

struct ClampScene : PathScene {
  ClampScene() : PathScene(24, 24) {
    ChiangParams fibre;
    fibre.absorption = Rgb(0.1f, 0.2f, 0.4f);
    add_fur(furball(300, 0.5f, 0.02f), fibre);
    SphereLightParams spark;
    spark.position = V3f(-2, 3, 2);
    spark.radius = 0.1f;
    spark.radiance = Rgb(400);
    add_light("spark", spark);
    add_sky(Rgb(0.1f));
    camera.fov = 18;
    render.samples = 32;
    render.bounces = 6;
  }
  FrameResult with(float limit, int bounces = 6) {
    render.clamp_indirect = limit;
    render.bounces = bounces;
    return run();
  }
};

double luminance_of(const FrameResult& result) { return luminance(picture_mean(result.film).mean); }

void expect_same_pixels(const Film& a, const Film& b) {
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) ASSERT_EQ(a.radiance(x, y), b.radiance(x, y)) << x << " " << y;
  }
}

TEST(IndirectClamp, ALimitThatNothingReachesChangesNoPixel) {
  ClampScene scene;
  const FrameResult free = scene.with(0), high = scene.with(1e9f);
  EXPECT_EQ(free.clamped_fraction, 0);
  EXPECT_EQ(high.clamped_fraction, 0);
  expect_same_pixels(free.film, high.film);
}

TEST(IndirectClamp, LeavesDirectLightAlone) {
  ClampScene scene;
  const FrameResult free = scene.with(0, 0), low = scene.with(1e-6f, 0);
  EXPECT_EQ(low.clamped_fraction, 0);
  expect_same_pixels(free.film, low.film);
}

TEST(IndirectClamp, SaysWhatItTakes) {
  ClampScene scene;
  const double direct = luminance_of(scene.with(0, 0));
  const double all = luminance_of(scene.with(0));
  const FrameResult clamped = scene.with(0.4f);
  const double lost = (all - luminance_of(clamped)) / (all - direct);
  EXPECT_GT(lost, 0.02);
  // The same paths with and without the limit; only the luminance of direct light is of another render.
  EXPECT_NEAR(clamped.clamped_fraction, lost, 0.02 * lost + 1e-3);
  // Hardly anything is left under a limit of hardly anything.
  const FrameResult dark = scene.with(1e-4f);
  EXPECT_GT(dark.clamped_fraction, 0.99);
  EXPECT_NEAR(luminance_of(dark), direct, 0.01 * all);
}

TEST(IndirectClamp, IsTheSameForAnyNumberOfThreads) {
  ClampScene scene;
  scene.render.clamp_indirect = 0.5f;
  const FrameResult one = scene.run({}, 1), three = scene.run({}, 3);
  EXPECT_EQ(one.clamped_fraction, three.clamped_fraction);
  expect_same_pixels(one.film, three.film);
}

}  // namespace
}  // namespace pelage
