// SPDX-License-Identifier: Apache-2.0
// How much noise adaptive sampling leaves, and how many samples it takes.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "render/render_frame.h"
#include "render/sampling/adaptive_rule.h"
#include "tests/render/path/lamp_scene.h"

namespace pelage {
namespace {

double mean_luminance(const Film& film) { return luminance(picture_mean(film).mean); }

/// Standard error of mean_luminance() by what the film says of its pixels.
double standard_error(const Film& film) {
  double sum = 0;
  for (const PixelMoments& pixel : film.moments()) sum += pixel.error() * pixel.error();
  return std::sqrt(sum) / static_cast<double>(film.moments().size());
}

TEST(AdaptivePath, TheMeanIsThatOfPlainSampling) {
  LampScene scene;
  const FrameResult adaptive = scene.run();
  scene.render.adaptive.reset();
  scene.render.seed = 1;
  scene.image.noise_layers = true;
  const FrameResult plain = scene.run();
  const double error = std::hypot(standard_error(adaptive.film), standard_error(plain.film));
  EXPECT_LT(error, 0.01 * mean_luminance(plain.film));
  EXPECT_NEAR(mean_luminance(adaptive.film), mean_luminance(plain.film), 3 * error);
}

TEST(AdaptivePath, TheBudgetIsKeptAndTheSkyCostsAQuarterOfThePilot) {
  LampScene scene;
  scene.render.samples = 1 << 14;
  scene.render.adaptive->noise = 0.06f;
  const FrameResult result = scene.run();
  // Strands narrower than a pixel: neighbours say less of a pixel's brightness than they do in dense fur.
  EXPECT_NEAR(result.noise, 0.06, 0.2 * 0.06);
  EXPECT_EQ(result.samples, 4u);
  EXPECT_EQ(result.film.samples(0, 0), 4u) << "nothing but sky";
  EXPECT_GT(result.mean_samples, 32);
  const size_t fur = std::count_if(result.film.moments().begin(), result.film.moments().end(),
                                   [](const PixelMoments& m) { return m.squares > 0; });
  EXPECT_GT(fur, 300u);
}

TEST(AdaptivePath, PixelByPixelMostKeepTheBudget) {
  LampScene scene;
  scene.render.samples = 1 << 14;
  scene.render.adaptive->noise = 0.4f;
  scene.render.adaptive->goal = NoiseGoal::kPixel;
  const FrameResult result = scene.run();
  size_t kept = 0, noisy = 0;
  const double floor = 0.1 * mean_luminance(result.film);
  for (const PixelMoments& pixel : result.film.moments()) {
    if (!(pixel.squares > 0)) continue;
    ++noisy;
    kept += kConfidence * pixel.error() <= 0.4 * std::hypot(pixel.mean, floor);
  }
  EXPECT_GT(static_cast<double>(kept), 0.85 * static_cast<double>(noisy));
}

}  // namespace
}  // namespace pelage
