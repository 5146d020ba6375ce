// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "render/render_frame.h"
#include "tests/render/film/film_picture.h"
#include "tests/render/path/skin_ball_scene.h"

namespace pelage::skin_ball_test {
namespace {

void expect_equal(const ExrImage& a, const ExrImage& b) {
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (size_t i = 0; i < a.channels.size(); ++i)
    EXPECT_EQ(a.channels[i].pixels, b.channels[i].pixels) << a.channels[i].name;
}

class SkinBallTest : public testing::TestWithParam<Integrator> {
 protected:
  void use(SkinBallScene& scene) const { scene.render.integrator = GetParam(); }
};

TEST_P(SkinBallTest, OneAndManyThreadsGiveTheSameFilm) {
  SkinBallScene scene(moving(sphere_skin(20)));
  use(scene);
  scene.render.skin_ball = SkinBallUse::kExact;
  expect_equal(picture_of(scene.run({}, 1).film), picture_of(scene.run({}, 4).film));
}

// Without a ball, nothing is left out, and no random number is used differently.
TEST_P(SkinBallTest, AnOpenSkinChangesNoPixel) {
  SkinMesh open = sphere_skin(20);
  open.triangles.resize(open.triangles.size() - 3);
  open.faces.pop_back();
  open.vertex_uv.resize(open.triangles.size());
  SkinBallScene scene(open);
  use(scene);
  const ExrImage off = picture_of(scene.run({}, 2).film);
  scene.render.skin_ball = SkinBallUse::kExact;
  const FrameResult result = scene.run({}, 2);
  EXPECT_EQ(result.statistics.occlusion.candidates_proved, 0);
  expect_equal(off, picture_of(result.film));
}

TEST_P(SkinBallTest, KeepsTheMeanAndSavesRays) {
  double mean[2] = {0, 0}, square[2] = {0, 0};
  int64_t shadow[2] = {0, 0};
  constexpr int kRuns = 12;
  for (const bool exact : {false, true}) {
    SkinBallScene scene;
    use(scene);
    scene.render.samples = 48;
    scene.render.skin_ball = exact ? SkinBallUse::kExact : SkinBallUse::kOff;
    for (int run = 0; run < kRuns; ++run) {
      scene.render.seed = 2 * run + exact;
      const FrameResult result = scene.run({}, 2);
      const double of_run = luminance(picture_mean(result.film).mean);
      mean[exact] += of_run / kRuns;
      square[exact] += of_run * of_run / kRuns;
      shadow[exact] += result.statistics.rays.shadow;
      EXPECT_EQ(result.statistics.occlusion.candidates_proved > 0, exact);
    }
  }
  const auto variance = [&](int i) { return (square[i] - mean[i] * mean[i]) / (kRuns - 1); };
  // 3.3 standard errors: a false alarm in a thousand.
  EXPECT_NEAR(mean[1], mean[0], 3.3 * std::sqrt(variance(0) + variance(1)));
  EXPECT_LT(3.3 * std::sqrt(variance(0) + variance(1)), 0.02 * mean[0]) << "too noisy to show a bias";
  if (GetParam() == Integrator::kPath) {
    EXPECT_LT(shadow[1], shadow[0]);
  }
}

INSTANTIATE_TEST_SUITE_P(Both, SkinBallTest, testing::Values(Integrator::kPath, Integrator::kGather),
                         [](const auto& test) {
                           return test.param == Integrator::kPath ? "Path" : "Gather";
                         });

}  // namespace
}  // namespace pelage::skin_ball_test
