// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "render/render_frame.h"
#include "tests/render/film/film_picture.h"
#include "tests/render/path/skin_ball_scene.h"

namespace pelage {
namespace {

void expect_equal(const ExrImage& a, const ExrImage& b) {
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (size_t i = 0; i < a.channels.size(); ++i)
    EXPECT_EQ(a.channels[i].pixels, b.channels[i].pixels) << a.channels[i].name;
}

/// Mean luminance over many pictures, its standard error, and the shadow rays of all pictures.
struct Runs {
  double mean = 0, error = 0;
  int64_t shadow = 0;
};
Runs run(SkinBallScene& scene, int seeds) {
  Runs runs;
  double squares = 0;
  for (int i = 0; i < seeds; ++i) {
    ++scene.render.seed;
    const FrameResult result = scene.run({}, 2);
    const double mean = luminance(picture_mean(result.film).mean);
    runs.mean += mean / seeds;
    squares += mean * mean / seeds;
    runs.shadow += result.statistics.rays.shadow;
  }
  runs.error = std::sqrt((squares - runs.mean * runs.mean) / (seeds - 1));
  return runs;
}

TEST(LearnedVisibilityPath, OneAndManyThreadsGiveTheSameFilm) {
  for (const Integrator integrator : {Integrator::kPath, Integrator::kGather}) {
    SkinBallScene scene;
    scene.render.integrator = integrator;
    scene.render.learned_visibility = LearnedUse::kOn;
    scene.render.skin_ball = SkinBallUse::kExact;
    expect_equal(picture_of(scene.run({}, 1).film), picture_of(scene.run({}, 4).film));
  }
}

TEST(LearnedVisibilityPath, KeepsTheMean) {
  SkinBallScene scene;
  scene.render.samples = 48;
  const Runs off = run(scene, 12);
  scene.render.learned_visibility = LearnedUse::kOn;
  const Runs on = run(scene, 12);
  const double error = std::hypot(off.error, on.error);
  EXPECT_NEAR(on.mean, off.mean, 3.3 * error);
  EXPECT_LT(3.3 * error, 0.02 * off.mean) << "too noisy to show a bias";
  EXPECT_GT(on.shadow, off.shadow) << "pilots";
}

TEST(LearnedVisibilityPath, IsRefusedWithoutRoom) {
  SkinBallScene scene;
  scene.render.learned_visibility = LearnedUse::kOn;
  scene.render.memory.bytes = uint64_t(3) << 20;
  try {
    scene.run({}, 2);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
    EXPECT_NE(std::string(error.what()).find("learning the visibility"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace pelage
