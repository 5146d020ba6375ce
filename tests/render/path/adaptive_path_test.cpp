// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "render/render_frame.h"
#include "render/sampling/adaptive_rule.h"
#include "tests/geom/random_strands.h"
#include "tests/render/film/film_picture.h"
#include "tests/render/path/path_scene.h"

namespace pelage {
namespace {

/// A small bright lamp seen through fur, with flat sky around.
struct LampScene : PathScene {
  LampScene() : PathScene(40, 32) {
    RandomStrandOptions o;
    o.strands = 150;
    o.radius = 0.03f;
    ConeShellParams fibre;
    fibre.color = Field(Rgb(0.9f));
    add_fur(random_strands(11, o), fibre);
    SphereLightParams lamp;
    lamp.position = V3f(1.5f, 2, -1);
    lamp.radius = 0.1f;
    lamp.radiance = Rgb(400);
    add_light("lamp", lamp);
    add_sky(Rgb(0.2f));
    camera.fov = 20.0f;
    render.samples = 512;
    render.adaptive = AdaptiveParams{};
    render.adaptive->noise = 0.15f;
  }
};

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

TEST(AdaptivePath, ThreadsMemoryAndPassesDoNotChangeThePicture) {
  for (AdaptiveRule rule : {AdaptiveRule::kTwoStage, AdaptiveRule::kSeed}) {
    LampScene scene;
    scene.render.samples = 300;
    scene.render.adaptive->rule = rule;
    const FrameResult one = scene.run({}, 1), many = scene.run({}, 4);
    const ExrImage a = picture_of(one.film), b = picture_of(many.film);
    ASSERT_EQ(a.channels.size(), b.channels.size());
    int named = 0;
    for (size_t i = 0; i < a.channels.size(); ++i) {
      EXPECT_EQ(a.channels[i].pixels, b.channels[i].pixels) << a.channels[i].name;
      EXPECT_EQ(a.channels[i].ids, b.channels[i].ids) << a.channels[i].name;
      named += a.channels[i].name == "samples" || a.channels[i].name == "noise";
    }
    EXPECT_EQ(named, 2);
    EXPECT_FALSE(one.time_limited);
  }
}

TEST(AdaptivePath, TheSeedRuleStopsEachPixelByItself) {
  LampScene scene;
  scene.render.adaptive->rule = AdaptiveRule::kSeed;
  const FrameResult result = scene.run();
  for (const PixelMoments& pixel : result.film.moments()) {
    EXPECT_EQ(pixel.count % 32, 0u);
    EXPECT_TRUE(looks_converged(pixel, 0.15) || pixel.count == 512);
  }
  EXPECT_EQ(result.samples, 32u);
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

TEST(AdaptivePath, ATimeLimitLeavesAWholePicture) {
  for (bool adaptive : {false, true}) {
    LampScene scene;
    scene.render.samples = 1 << 20;
    scene.render.adaptive->noise = 1e-4f;
    if (!adaptive) scene.render.adaptive.reset();
    scene.render.time_limit = 0.3f;
    const FrameResult result = scene.run();
    EXPECT_TRUE(result.time_limited);
    EXPECT_FALSE(result.partial);
    EXPECT_GE(result.samples, 1u);
    EXPECT_LT(result.mean_samples, 1 << 20);

    scene.render.time_limit = 1e-6f;
    EXPECT_EQ(scene.run().mean_samples, 1) << "one for every pixel, always";
    scene.render.time_limit = 1e6f;
    scene.render.samples = 4;
    EXPECT_FALSE(scene.run().time_limited);
  }
}

/// Records the reported progress.
class Bar final : public Progress {
 public:
  void begin(std::string_view, double total) override {
    done_ = 0;
    total_ = total;
  }
  void advance(double amount) override { done_ = done_ + amount; }
  void expect(double total) override { total_ = total; }
  void end() override { worst_ = std::max(worst_, std::abs(done_ - total_) / std::max(1.0, total_)); }
  bool cancelled() const override { return false; }
  double worst() const { return worst_; }

 private:
  double done_ = 0, total_ = 0, worst_ = 0;
};

TEST(AdaptivePath, TheProgressBarEndsFull) {
  for (AdaptiveRule rule : {AdaptiveRule::kTwoStage, AdaptiveRule::kSeed}) {
    LampScene scene;
    scene.render.samples = 128;
    scene.render.adaptive->rule = rule;
    Bar bar;
    scene.run({}, 1, bar);
    EXPECT_LT(bar.worst(), 1e-6);
  }
}

}  // namespace
}  // namespace pelage
