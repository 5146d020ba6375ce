// SPDX-License-Identifier: Apache-2.0
// The noise that `gather` reports, and adaptive sampling by it.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "render/render_frame.h"
#include "tests/render/path/lamp_scene.h"
#include "tests/support/effort.h"

namespace pelage {
namespace {

struct NoisyScene : LampScene {
  NoisyScene() {
    render.integrator = Integrator::kGather;
    render.bounces = 1;
    render.samples = 64;
    render.adaptive.reset();
    image.noise_layers = true;
  }
};

double brightness(const Film& film) { return luminance(picture_mean(film).mean); }

/// Mean over the pixels of the squared error that the film states.
double stated_variance(const Film& film) {
  double sum = 0;
  for (const PixelMoments& pixel : film.moments()) sum += pixel.error() * pixel.error();
  return sum / static_cast<double>(film.moments().size());
}

TEST(GatherNoise, StatedErrorIsTheTrueOne) {
  NoisyScene scene;
  scene.image.filter_samples = FilterSamples::kDrawn;
  const size_t seeds = at_least(8, 32);
  std::vector<PixelMoments> pixels(40 * 32);
  double stated = 0;
  for (size_t seed = 0; seed < seeds; ++seed) {
    scene.render.seed = static_cast<int64_t>(seed);
    const FrameResult result = scene.run();
    stated += stated_variance(result.film) / static_cast<double>(seeds);
    for (int i = 0; i < 40 * 32; ++i)
      pixels[static_cast<size_t>(i)].add(luminance(result.film.radiance(i % 40, i / 40)));
  }
  double true_variance = 0;
  for (const PixelMoments& pixel : pixels) true_variance += pixel.variance() / 1280;
  // The samples of a pixel are stratified over all parts, so the true error is somewhat smaller.
  EXPECT_GT(stated, 0.9 * true_variance);
  EXPECT_LT(stated, 1.8 * true_variance);
}

TEST(GatherNoise, AdaptiveTilesKeepTheMeanAndTheBudget) {
  NoisyScene scene;
  scene.render.samples = 512;
  const FrameResult plain = scene.run();
  scene.render.adaptive.emplace();
  scene.render.adaptive->noise = 0.1f;
  scene.render.seed = 1;
  const FrameResult adaptive = scene.run();
  // `noise` ignores the samples that neighbouring pixels share with a pixel by splatting.
  EXPECT_NEAR(adaptive.noise, 0.1, 0.03);
  EXPECT_LT(adaptive.film.samples(39, 31), adaptive.film.samples(20, 10)) << "less fur";
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 40; ++x)
      ASSERT_EQ(adaptive.film.samples(x, y), adaptive.film.samples(x / 16 * 16, y / 16 * 16));
  }
  const double error = std::sqrt((stated_variance(adaptive.film) + stated_variance(plain.film)) / 1280);
  EXPECT_LT(error, 0.01 * brightness(plain.film));
  // Neighbouring pixels share errors: their sum has more than that of independent pixels.
  EXPECT_NEAR(brightness(adaptive.film), brightness(plain.film), 6 * error);
}

TEST(GatherNoise, AdaptivePicturesDoNotDependOnThreads) {
  NoisyScene scene;
  scene.render.samples = 128;
  scene.render.adaptive.emplace();
  const FrameResult one = scene.run({}, 1), two = scene.run({}, 2);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 40; ++x) {
      ASSERT_EQ(one.film.samples(x, y), two.film.samples(x, y));
      ASSERT_EQ(one.film.radiance(x, y), two.film.radiance(x, y));
    }
  }
}

}  // namespace
}  // namespace pelage
