// SPDX-License-Identifier: Apache-2.0
#include "render/accel/min_width.h"

#include <cmath>

#include <gtest/gtest.h>

#include "geom/root_detail.h"
#include "tests/render/raster/raster_scene.h"

namespace pelage {
namespace {

constexpr int kSize = 32;  // four tiles

/// A scene whose pixels are 0.11 units wide at the origin.
struct WideningScene : RasterScene {
  explicit WideningScene(float pixels) : RasterScene(kSize, kSize) {
    render.integrator = Integrator::kGather;
    render.gather.visibility = GatherVisibility::kRaster;
    render.gather.min_width = pixels;
  }
};

/// Bent strands, 5 pixels apart.
Strands thin_strands(float radius, int motion_keys = 1) {
  StrandArrays a;
  a.motion_keys = motion_keys;
  a.first_point = {0};
  for (int key = 0; key < motion_keys; ++key) {
    for (uint32_t i = 0; i < 5; ++i) {
      for (const float x : {-1.0f, -0.3f, 0.4f, 1.0f}) {
        const float y = 0.55f * static_cast<float>(i) - 1.2f + 0.2f * x + 0.1f * x * x;
        a.points.insert(a.points.end(), {x + 0.3f * static_cast<float>(key), y, 0, radius * (1.5f - x)});
      }
      if (key > 0) continue;
      a.ids.push_back(i);
      a.first_point.push_back(a.first_point.back() + 4);
    }
  }
  return Strands(std::move(a));
}

/// Samples that see strands, by rays (at their true width) and by drawing (widened), over pictures with
/// several seeds.
struct Coverage {
  double thin = 0, wide = 0;                    ///< mean of all pixels
  double thin_variance = 0, wide_variance = 0;  ///< of a pixel, mean of all pixels
  double deviation = 0;                         ///< standard error of wide - thin
};

Coverage coverage(RasterScene& scene, uint32_t samples, int seeds) {
  struct Sum {
    double thin = 0, thin2 = 0, wide = 0, wide2 = 0;
  };
  std::vector<Sum> pixels(kSize * kSize);
  Coverage result;
  double all = 0, all2 = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    scene.render.seed = seed;
    std::vector<int> thin(pixels.size(), 0), wide(pixels.size(), 0);
    scene.compare(samples, [&](int x, int y, const Hit& ray, const Hit& drawn) {
      thin[static_cast<size_t>(y * kSize + x)] += ray ? 1 : 0;
      wide[static_cast<size_t>(y * kSize + x)] += drawn ? 1 : 0;
    });
    double difference = 0;
    for (size_t i = 0; i < pixels.size(); ++i) {
      const double t = double(thin[i]) / samples, w = double(wide[i]) / samples;
      pixels[i].thin += t, pixels[i].thin2 += t * t, pixels[i].wide += w, pixels[i].wide2 += w * w;
      difference += w - t;
    }
    all += difference, all2 += difference * difference;
  }
  const double n = seeds, count = double(pixels.size());
  for (const Sum& sum : pixels) {
    result.thin += sum.thin / n / count;
    result.wide += sum.wide / n / count;
    result.thin_variance += (sum.thin2 / n - sum.thin / n * sum.thin / n) / count;
    result.wide_variance += (sum.wide2 / n - sum.wide / n * sum.wide / n) / count;
  }
  result.deviation = std::sqrt(std::max(0.0, all2 / n - all / n * all / n) / (n - 1)) / count;
  return result;
}

void expect_same_mean(const Coverage& seen) {
  EXPECT_GT(seen.thin, 1e-4);
  EXPECT_NEAR(seen.wide, seen.thin, 3 * seen.deviation) << seen.deviation;
}

TEST(MinWidth, KeepsTheMean) {
  for (const float pixels : {1.0f, 2.0f}) {
    WideningScene scene(pixels);
    scene.add_fur(thin_strands(0.01f), diffuse_fibre(Rgb(0.5f)));  // 0.1 to 0.5 pixels wide
    expect_same_mean(coverage(scene, 64, 24));
  }
}

TEST(MinWidth, ReducesTheVarianceOfVeryThinStrands) {
  for (const float radius : {0.0005f, 0.002f}) {  // about 0.01 and 0.04 pixels wide
    WideningScene scene(2);
    scene.add_fur(thin_strands(radius), diffuse_fibre(Rgb(0.5f)));
    const Coverage seen = coverage(scene, 64, 24);
    expect_same_mean(seen);
    EXPECT_LT(seen.wide_variance, 0.9 * seen.thin_variance);
  }
}

TEST(MinWidth, KeepsTheMeanOfStrandsThatMove) {
  WideningScene scene(2);
  scene.camera.shutter = V2f(0, 0.5f);
  scene.add_fur(thin_strands(0.01f, 2), diffuse_fibre(Rgb(0.5f)));
  expect_same_mean(coverage(scene, 16, 24));
}

TEST(MinWidth, KeepsTheOpacityOfStrands) {
  WideningScene scene(1);
  ConeShellParams fibre = diffuse_fibre(Rgb(0.5f));
  fibre.opacity = Field(0.4f);
  scene.add_fur(thin_strands(0.01f), fibre);
  expect_same_mean(coverage(scene, 16, 24));
}

TEST(MinWidth, ChangesOnlyTheThinTipsOfWiderStrands) {
  WideningScene scene(0.01f);
  scene.add_fur(thin_strands(0.2f), diffuse_fibre(Rgb(0.5f)));
  const RasterScene::Agreement seen = scene.compare(16);
  EXPECT_GE(static_cast<double>(seen.same), 0.99 * static_cast<double>(seen.samples));
}

TEST(MinWidth, DoesNotWidenStrandsThatLevelOfDetailHasWidened) {
  for (const float share : {1.0f, 0.3f}) {
    WideningScene scene(1);
    Strands strands = thin_strands(0.01f);
    const std::vector<RootDetail> details(strands.strand_count(), RootDetail(V3f(0, 0, 1), share));
    scene.add_fur(RootDetail::added(std::move(strands), details), diffuse_fibre(Rgb(0.5f)));
    const RasterScene::Agreement seen = scene.compare(16);
    const double same = static_cast<double>(seen.same) / static_cast<double>(seen.samples);
    EXPECT_EQ(same >= 0.998, share < 1) << same;
  }
}

}  // namespace
}  // namespace pelage
