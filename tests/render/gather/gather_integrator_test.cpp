// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "render/gather/gather_tracer.h"
#include "render/light/far_light_samples.h"
#include "tests/render/film/film_picture.h"
#include "tests/render/gather/gather_scene.h"
#include "tests/render/path/impatient.h"

namespace pelage {
namespace {

void expect_same(const Film& a, const Film& b) {
  const ExrImage one = picture_of(a), other = picture_of(b);
  ASSERT_EQ(one.channels.size(), other.channels.size());
  for (size_t i = 0; i < one.channels.size(); ++i) {
    EXPECT_EQ(one.channels[i].pixels, other.channels[i].pixels) << one.channels[i].name;
    EXPECT_EQ(one.channels[i].ids, other.channels[i].ids) << one.channels[i].name;
  }
}

TEST(GatherIntegrator, OneAndManyThreadsGiveTheSameFilm) {
  for (const bool reuse : {false, true}) {
    GatherScene scene;
    scene.render.gather.reuse = reuse;
    const FrameResult one = scene.run({}, 1);
    expect_same(one.film, scene.run({}, 4).film);
  }
}

TEST(GatherIntegrator, DrawingGivesTheSameFilmWithAnyThreadsAndSeesWhatRaysSee) {
  GatherScene scene;
  scene.image.filter_samples = FilterSamples::kSplatted;
  scene.render.gather.visibility = GatherVisibility::kRays;
  const FrameResult traced = scene.run({}, 1);
  scene.render.gather.visibility = GatherVisibility::kRaster;
  const FrameResult drawn = scene.run({}, 1);
  expect_same(drawn.film, scene.run({}, 4).film);
  double alpha = 0, depths = 0, pixels = 0;
  for (int y = 0; y < scene.image.height; ++y) {
    for (int x = 0; x < scene.image.width; ++x) {
      alpha += std::abs(drawn.film.alpha(x, y) - traced.film.alpha(x, y));
      depths += drawn.film.surface(x, y).depth == traced.film.surface(x, y).depth ? 1 : 0;
      ++pixels;
    }
  }
  EXPECT_LT(alpha / pixels, 0.002);
  EXPECT_GT(depths / pixels, 0.98);
}

TEST(GatherIntegrator, ThreadsThatWaitForMemoryGiveTheSameFilm) {
  GatherScene scene;
  scene.render.gather.cache = false;  // its memory has the same tag
  const FrameResult free = scene.run({}, 3);
  const size_t tile = GatherTracer::scratch_bytes(scene.lights.size(), 8, scene.render.draws_visible());
  scene.render.memory.bytes = 16 * tile;  // two tiles at once
  expect_same(free.film, scene.run({}, 3).film);
  // One light is an environment: 32 bytes per stored point (FarLightSamples::bytes()).
  const size_t most = 3 * tile + 32 * size_t{FarLightSamples::kSide} * FarLightSamples::kSide;
  EXPECT_LE(scene.ledger.peak(MemoryTag::kReflectionCache), static_cast<int64_t>(most));
  EXPECT_EQ(scene.ledger.current(MemoryTag::kReflectionCache), 0);

  scene.render.memory.bytes = tile / 2;
  try {
    scene.run();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
  }
}

TEST(GatherIntegrator, LayersAddUpToThePicture) {
  GatherScene scene;
  const FrameResult result = scene.run();
  const Film& film = result.film;
  ASSERT_EQ(film.layers().size(), 7u);
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      Rgb sum(0);
      for (size_t i = 0; i < film.layers().size(); ++i) sum += film.layer(x, y, i);
      const Rgb whole = film.radiance(x, y);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], whole[c], 2e-5f * (1 + whole[c]));
    }
  }
}

TEST(GatherIntegrator, SurfaceDataAndCoverageAreThoseOfPaths) {
  GatherScene scene;
  scene.image.filter_samples = FilterSamples::kSplatted;
  scene.render.gather.visibility = GatherVisibility::kRays;
  const FrameResult gathered = scene.run();
  scene.render.integrator = Integrator::kPath;
  const FrameResult traced = scene.run();
  for (int y = 0; y < scene.image.height; ++y) {
    for (int x = 0; x < scene.image.width; ++x) {
      const VisibleSurface &a = gathered.film.surface(x, y), &b = traced.film.surface(x, y);
      EXPECT_EQ(a.depth, b.depth) << x << ", " << y;
      EXPECT_EQ(a.normal, b.normal);
      EXPECT_EQ(a.forward, b.forward);
      EXPECT_EQ(a.id, b.id);
      EXPECT_NEAR(gathered.film.alpha(x, y), traced.film.alpha(x, y), 1e-6f) << "added in another order";
      EXPECT_EQ(gathered.film.samples(x, y), traced.film.samples(x, y));
    }
  }
}

TEST(GatherIntegrator, AnInterruptedPictureHasEveryPixel) {
  GatherScene scene;
  const double pixels = scene.image.width * scene.image.height;
  Impatient progress(4 * pixels);  // after the preview and less than half of the eight samples
  const FrameResult partial = scene.run({}, 1, progress);
  EXPECT_TRUE(partial.partial);
  EXPECT_EQ(partial.samples, 1u);
  EXPECT_GT(scene.statistics.rays.camera, static_cast<int64_t>(pixels));
  EXPECT_GT(scene.statistics.cpu_s.total(), 0);
  const FrameResult whole = scene.run();
  EXPECT_EQ(whole.samples, 8u);
  int finished = 0;
  for (int y = 0; y < scene.image.height; ++y) {
    for (int x = 0; x < scene.image.width; ++x) {
      const uint32_t samples = partial.film.samples(x, y);
      EXPECT_TRUE(samples == 1 || samples == 8) << samples;
      finished += samples == 8;
    }
  }
  EXPECT_GT(finished, 0);
  EXPECT_LT(finished, pixels);
  EXPECT_EQ(partial.film.radiance(2, 2), whole.film.radiance(2, 2)) << "in the first tile";
}

TEST(GatherIntegrator, DividesItsCpuTime) {
  GatherScene one, four;
  one.run({}, 1);
  four.run({}, 4);
  for (const GatherScene* scene : {&one, &four}) {
    const RenderSeconds& cpu_s = scene->statistics.cpu_s;
    for (const double part : {cpu_s.camera_rays, cpu_s.shadow_rays, cpu_s.indirect_rays}) EXPECT_GT(part, 0);
  }
  const RayStatistics &a = one.statistics.rays, &b = four.statistics.rays;
  EXPECT_EQ(a.camera, b.camera);
  EXPECT_EQ(a.shadow, b.shadow);
  EXPECT_EQ(a.indirect, b.indirect);
}

TEST(GatherIntegrator, TheSamplesOfAllPassesCount) {
  GatherScene scene;
  scene.render.gather.cache = false;  // filling it takes camera rays, too
  scene.render.samples = 4;
  const FrameResult four = scene.run();
  EXPECT_EQ(four.samples, 4u);
  EXPECT_EQ(scene.statistics.rays.camera, 4 * 40 * 30);
  scene.render.samples = 8;
  const FrameResult eight = scene.run();
  EXPECT_EQ(eight.samples, 8u);
  EXPECT_EQ(eight.mean_samples, 8);
  EXPECT_EQ(scene.statistics.rays.camera, (4 + 8) * 40 * 30);
  EXPECT_EQ(scene.statistics.samples_rejected, 0);
}

TEST(GatherIntegrator, CountsGatherPointsAndTheirSamples) {
  GatherScene scene;
  scene.render.gather.reuse = false;
  const GatherPointStatistics alone = scene.run({}, 1).statistics.gather_points;
  EXPECT_GT(alone.samples, 0);
  EXPECT_LE(alone.samples, scene.render.samples * 40 * 30) << "no more than the samples of the frame";
  EXPECT_EQ(alone.count, alone.samples);
  scene.render.gather.reuse = true;
  const GatherPointStatistics shared = scene.run({}, 1).statistics.gather_points;
  EXPECT_EQ(shared.samples, alone.samples);
  EXPECT_GT(shared.count, 0);
  EXPECT_LT(shared.count, shared.samples / 2);
  EXPECT_EQ(scene.run({}, 4).statistics.gather_points.count, shared.count);
}

TEST(GatherIntegrator, MorePassesThanOneAddUp) {
  GatherScene scene;
  scene.image.width = scene.image.height = 20;
  const uint32_t max = GatherTracer::max_samples(scene.lights.size());
  scene.render.samples = static_cast<int>(max + 3);
  const FrameResult result = scene.run();
  EXPECT_EQ(result.samples, max + 3);
  EXPECT_EQ(result.mean_samples, max + 3);
}

TEST(GatherIntegrator, ATimeLimitEndsWithAValidPicture) {
  GatherScene scene;
  scene.render.samples = 1 << 20;
  scene.render.time_limit = 0.05f;
  const FrameResult result = scene.run();
  EXPECT_TRUE(result.time_limited);
  EXPECT_FALSE(result.partial);
  EXPECT_GE(result.samples, 1u);
  EXPECT_LT(result.samples, 1u << 20);
}

}  // namespace
}  // namespace pelage
