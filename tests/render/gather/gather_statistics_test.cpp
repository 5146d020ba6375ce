// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/sampling/pixel_moments.h"
#include "tests/render/gather/gather_scene.h"
#include "tests/render/path/skin_ball_scene.h"

namespace pelage {
namespace {

constexpr int kSide = 8, kSeeds = 24;

/// Moments over pictures of several seeds: of the luminance of each block of 8 x 8 pixels.
std::vector<PixelMoments> block_moments(PathScene& scene, uint64_t first_seed) {
  const int columns = scene.image.width / kSide, rows = scene.image.height / kSide;
  std::vector<PixelMoments> blocks(static_cast<size_t>(columns * rows));
  for (int seed = 0; seed < kSeeds; ++seed) {
    scene.render.seed = static_cast<int64_t>(first_seed) + seed;
    const FrameResult result = scene.run();
    for (size_t b = 0; b < blocks.size(); ++b) {
      const int x0 = static_cast<int>(b) % columns * kSide, y0 = static_cast<int>(b) / columns * kSide;
      double sum = 0;
      for (int i = 0; i < kSide * kSide; ++i) {
        sum += luminance(result.film.radiance(x0 + i % kSide, y0 + i / kSide));
      }
      blocks[b].add(sum / (kSide * kSide));
    }
  }
  return blocks;
}

struct Comparison {
  int far_off = 0;
  double spread = 0;    ///< rms of the differences of blocks, in standard errors: 1 if both have one mean
  double relative = 0;  ///< of the means of the pictures
  double error = 0;     ///< standard error of the latter
};

Comparison compare(const std::vector<PixelMoments>& a, const std::vector<PixelMoments>& b) {
  Comparison result;
  double difference = 0, whole = 0, variance = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double error = std::hypot(a[i].error(), b[i].error()) + 1e-5;
    const double z = (a[i].mean - b[i].mean) / error;
    result.far_off += std::abs(z) > 4.2;  // two-sided, Student with 46 degrees of freedom: 1.2e-4 each
    result.spread += z * z;
    difference += a[i].mean - b[i].mean;
    whole += b[i].mean;
    variance += error * error;
  }
  result.spread = std::sqrt(result.spread / static_cast<double>(a.size()));
  result.relative = difference / whole;
  result.error = std::sqrt(variance) / whole;
  return result;
}

/// Renders with paths (splatted) and with gather.
Comparison against_paths(PathScene& scene) {
  scene.image.filter_samples = FilterSamples::kSplatted;
  scene.render.integrator = Integrator::kPath;
  const std::vector<PixelMoments> paths = block_moments(scene, 1000);
  scene.render.integrator = Integrator::kGather;
  return compare(block_moments(scene, 0), paths);
}

TEST(GatherWithoutReuse, HasTheMeanOfPaths) {
  GatherScene scene;
  scene.render.gather.reuse = false;
  const Comparison result = against_paths(scene);
  EXPECT_EQ(result.far_off, 0);
  EXPECT_LT(result.spread, 1.5);
  EXPECT_LT(std::abs(result.relative), 4 * result.error + 1e-4);
}

TEST(GatherWithoutReuse, HasTheMeanOfPathsThroughOtherModels) {
  for (const bool chiang : {false, true}) {
    PathScene scene(40, 32);
    scene.camera.fov = 20;
    scene.add_fur(furball(300, 1.0f, 0.02f),
                  chiang ? MaterialParams(ChiangParams{}) : MaterialParams(MarschnerParams{}));
    SphereLightParams lamp;
    lamp.position = V3f(-2, 3, -4);  // from behind
    lamp.radius = 0.5f;
    lamp.radiance = Rgb(30);
    scene.add_light("lamp", lamp);
    scene.add_sky(Rgb(0.3f));
    scene.render.samples = 8;
    scene.render.bounces = 3;
    scene.render.gather.reuse = false;
    const Comparison result = against_paths(scene);
    EXPECT_EQ(result.far_off, 0) << chiang;
    EXPECT_LT(result.spread, 1.5);
    EXPECT_LT(std::abs(result.relative), 4 * result.error + 1e-4);
  }
}

/// With reuse, light moves along strands but is not lost. Strands are several pixels wide, so that most noise
/// is that of light. Most of what is shared is direct light.
TEST(GatherWithReuse, HasTheMeanOfPathsAndLessVariance) {
  PathScene scene(48, 40);
  scene.camera.fov = 10;
  scene.add_fur(furball(400, 0.8f, 0.03f), diffuse_fibre(Rgb(0.7f)));
  RectangleLightParams key;
  key.position = V3f(3, 3, 3);
  key.look_at = V3f(0);
  key.size = V2f(2, 2);
  key.radiance = Rgb(5);
  scene.add_light("key", key);
  scene.add_sky(Rgb(0.2f));
  scene.image.filter = PixelFilter::kBlackmanHarris;
  scene.render.samples = 12;
  scene.render.bounces = 2;
  const Comparison result = against_paths(scene);
  EXPECT_LT(std::abs(result.relative), 4 * result.error + 0.005);

  scene.render.bounces = 0;
  const auto variance = [&](Integrator integrator) {
    scene.render.integrator = integrator;
    std::vector<PixelMoments> pixels(48 * 40);
    for (int seed = 0; seed < kSeeds; ++seed) {
      scene.render.seed = seed;
      const FrameResult picture = scene.run();
      for (size_t p = 0; p < pixels.size(); ++p) {
        pixels[p].add(luminance(picture.film.radiance(static_cast<int>(p) % 48, static_cast<int>(p) / 48)));
      }
    }
    double sum = 0;
    for (const PixelMoments& pixel : pixels) sum += pixel.variance();
    return sum;
  };
  EXPECT_LT(variance(Integrator::kGather), 0.75 * variance(Integrator::kPath)) << "both splatted";
}

// Lights of a group share what is known about their shadows; light layers keep them apart.
TEST(GatherWithReuse, HasTheMeanOfPathsWithManyLights) {
  for (const bool layers : {false, true}) {
    PathScene scene(24, 24);
    scene.camera.fov = 8;
    scene.add_fur(furball(400, 0.8f, 0.03f), diffuse_fibre(Rgb(0.7f)));
    SphereLightParams lamp;
    lamp.radius = 0.1f;
    for (int i = 0; i < 64; ++i) {
      lamp.position = V3f(static_cast<float>(i % 8) - 3.5f, 3, static_cast<float>(i / 8) - 3.5f);
      lamp.radiance = Rgb(i % 3 == 0 ? 60.0f : 20.0f);
      scene.add_light("lamp" + std::to_string(i), lamp);
    }
    scene.add_sky(Rgb(0.1f));
    scene.image.light_layers = layers;
    scene.render.samples = layers ? 6 : 16;
    scene.render.bounces = 2;
    const Comparison result = against_paths(scene);
    EXPECT_LT(std::abs(result.relative), 3 * result.error + 0.002) << layers;
    EXPECT_LT(result.error, layers ? 0.008 : 0.004);
  }
}

// The rule of the film, with its bias: what the first rays of a tile miss stays dark.
TEST(GatherWithReuse, RejectionLosesLight) {
  SkinBallScene scene;
  scene.render.integrator = Integrator::kGather;
  scene.render.bounces = 0;
  scene.render.samples = 8;
  const std::vector<PixelMoments> guessed = block_moments(scene, 1);
  scene.render.gather.reject = true;
  const Comparison result = compare(block_moments(scene, 101), guessed);
  EXPECT_LT(result.relative, -4 * result.error);
}

}  // namespace
}  // namespace pelage
