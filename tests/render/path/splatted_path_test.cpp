// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "render/sampling/pixel_moments.h"
#include "tests/geom/random_strands.h"
#include "tests/render/path/path_scene.h"

namespace pelage {
namespace {

/// Fur under a sky, with the wide filter.
struct FurScene : PathScene {
  FurScene() : PathScene(40, 32) {
    RandomStrandOptions o;
    o.strands = 400;
    o.radius = 0.02f;
    add_fur(random_strands(11, o), ConeShellParams{});
    RectangleLightParams key;
    key.position = V3f(3, 3, 3);
    key.look_at = V3f(0);
    key.size = V2f(2, 2);
    key.radiance = Rgb(5);
    add_light("key", key);
    add_sky(Rgb(0.2f));
    camera.fov = 20.0f;
    image.filter = PixelFilter::kBlackmanHarris;
    render.samples = 8;
    render.bounces = 1;
  }
};

/// Of each pixel's luminance over pictures of several seeds.
std::vector<PixelMoments> moments_over_seeds(FurScene& scene, FilterSamples filter_samples) {
  constexpr int kSeeds = 24;
  scene.image.filter_samples = filter_samples;
  std::vector<PixelMoments> pixels(static_cast<size_t>(scene.image.width) *
                                   static_cast<size_t>(scene.image.height));
  for (int seed = 0; seed < kSeeds; ++seed) {
    scene.render.seed = seed;
    const FrameResult result = scene.run();
    for (size_t p = 0; p < pixels.size(); ++p) {
      const int x = static_cast<int>(p) % scene.image.width, y = static_cast<int>(p) / scene.image.width;
      pixels[p].add(luminance(result.film.radiance(x, y)));
    }
  }
  return pixels;
}

TEST(SplattedPath, HasTheMeanOfDrawnSamplesAndHalfTheirVariance) {
  FurScene scene;
  const auto drawn = moments_over_seeds(scene, FilterSamples::kDrawn);
  const auto splatted = moments_over_seeds(scene, FilterSamples::kSplatted);
  double drawn_variance = 0, splatted_variance = 0;
  size_t far_off = 0;
  for (size_t p = 0; p < drawn.size(); ++p) {
    drawn_variance += drawn[p].variance();
    splatted_variance += splatted[p].variance();
    const double error = std::hypot(drawn[p].error(), splatted[p].error());
    far_off += std::abs(drawn[p].mean - splatted[p].mean) > 4.5 * error + 1e-4;
  }
  EXPECT_LT(splatted_variance, 0.6 * drawn_variance);
  EXPECT_GT(splatted_variance, 0.3 * drawn_variance) << "no filter of this width can save more";
  EXPECT_LE(far_off, 2u) << "of " << drawn.size() << " pixels";
}

}  // namespace
}  // namespace pelage
