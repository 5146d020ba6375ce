// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "render/render_frame.h"
#include "tests/render/film/film_picture.h"
#include "tests/render/path/busy_scene.h"
#include "tests/render/path/impatient.h"

namespace pelage {
namespace {

TEST(PathIntegrator, OneAndManyThreadsGiveTheSameFilm) {
  for (const FilterSamples filter_samples : {FilterSamples::kDrawn, FilterSamples::kSplatted}) {
    BusyScene scene;
    scene.image.filter_samples = filter_samples;
    const ExrImage one = picture_of(scene.run({}, 1).film);
    const ExrImage many = picture_of(scene.run({}, 4).film);
    ASSERT_EQ(one.channels.size(), many.channels.size());
    for (size_t i = 0; i < one.channels.size(); ++i) {
      EXPECT_EQ(one.channels[i].pixels, many.channels[i].pixels) << one.channels[i].name;
      EXPECT_EQ(one.channels[i].ids, many.channels[i].ids) << one.channels[i].name;
    }
  }
}

TEST(PathIntegrator, LayersAddUpToThePicture) {
  BusyScene scene;
  const FrameResult result = scene.run();
  const Film& film = result.film;
  ASSERT_EQ(film.layers().names,
            (std::vector<std::string>{"key.diffuse", "key.primary", "key.secondary", "sky.diffuse",
                                      "sky.primary", "sky.secondary", "sky.emission"}));
  std::vector<float> brightest(film.layers().size(), 0.0f);
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      Rgb sum(0);
      for (size_t i = 0; i < film.layers().size(); ++i) {
        sum += film.layer(x, y, i);
        brightest[i] = std::max(brightest[i], luminance(film.layer(x, y, i)));
      }
      const Rgb whole = film.radiance(x, y);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], whole[c], 1e-5f * (1 + whole[c]));
    }
  }
  for (size_t i = 0; i < brightest.size(); ++i) EXPECT_GT(brightest[i], 0) << film.layers().names[i];

  scene.image.light_layers = false;
  const FrameResult plain = scene.run();
  EXPECT_TRUE(plain.film.layers().empty());
  EXPECT_EQ(plain.film.radiance(20, 15), film.radiance(20, 15));
}

TEST(PathIntegrator, CountsWhatItDid) {
  BusyScene scene;
  const FrameResult result = scene.run();
  EXPECT_EQ(result.samples, 8u);
  EXPECT_FALSE(result.partial);
  EXPECT_EQ(scene.statistics.rays.camera, 40 * 30 * 8);
  EXPECT_GT(scene.statistics.rays.shadow, 1000);
  EXPECT_GT(scene.statistics.rays.indirect, 500);
  EXPECT_EQ(scene.statistics.samples_rejected, 0);
  EXPECT_EQ(scene.statistics.growth.strands, 300);
  EXPECT_EQ(scene.statistics.growth.chunks, 4) << "two batches of strands, two skins";
  EXPECT_EQ(scene.statistics.residency.expansions, scene.statistics.residency.touched);
  EXPECT_GT(scene.statistics.trace.box_tests, scene.statistics.trace.chunk_visits);
  EXPECT_EQ(scene.ledger.current(MemoryTag::kChunks), 0);
  EXPECT_GT(scene.ledger.peak(MemoryTag::kChunks), 0);
}

TEST(PathIntegrator, DividesItsCpuTime) {
  BusyScene one, four;
  one.run({}, 1);
  four.run({}, 4);
  for (const BusyScene* scene : {&one, &four}) {
    const RenderSeconds& cpu_s = scene->statistics.cpu_s;
    for (const double part : {cpu_s.camera_rays, cpu_s.shadow_rays, cpu_s.indirect_rays}) EXPECT_GT(part, 0);
    EXPECT_GT(scene->statistics.residency.cpu_s, 0);
  }
  const RayStatistics &a = one.statistics.rays, &b = four.statistics.rays;
  EXPECT_EQ(a.camera, b.camera);
  EXPECT_EQ(a.shadow, b.shadow);
  EXPECT_EQ(a.indirect, b.indirect);
}

/// Asks to stop after this many checks since rendering began.
class Restless final : public Progress {
 public:
  void begin(std::string_view stage, double) override { rendering_ = stage == "render"; }
  void advance(double) override {}
  void end() override {}
  bool cancelled() const override { return rendering_ && left_.fetch_sub(1) <= 0; }

 private:
  std::atomic<bool> rendering_{false};
  mutable std::atomic<int> left_{10000};
};

TEST(PathIntegrator, NoSingleTileKeepsItFromStopping) {
  BusyScene scene;
  scene.image.width = scene.image.height = 4;
  scene.render.samples = 1 << 30;  // days
  Restless progress;
  const FrameResult partial = scene.run({}, 1, progress);
  EXPECT_TRUE(partial.partial);
  EXPECT_GT(partial.samples, 0u);
  EXPECT_LT(partial.mean_samples, 1 << 20);
}

TEST(PathIntegrator, AnInterruptedPictureIsAValidOneOfFewerSamples) {
  BusyScene scene;
  const int pixels = scene.image.width * scene.image.height;
  Impatient progress(2.5 * pixels);  // in the middle of the pass from 2 to 4
  const FrameResult partial = scene.run({}, 1, progress);
  EXPECT_TRUE(partial.partial);
  EXPECT_EQ(partial.samples, 2u);
  EXPECT_GE(scene.statistics.rays.camera, 2 * pixels);
  EXPECT_GT(scene.statistics.cpu_s.total(), 0);
  EXPECT_EQ(scene.statistics.growth.strands, 300);
  scene.render.samples = 2;
  const FrameResult two = scene.run();
  scene.render.samples = 4;
  const FrameResult four = scene.run();
  int with_two = 0, with_four = 0;
  for (int y = 0; y < scene.image.height; ++y) {
    for (int x = 0; x < scene.image.width; ++x) {
      const bool done = partial.film.samples(x, y) == 4;
      (done ? with_four : with_two)++;
      EXPECT_EQ(partial.film.radiance(x, y), (done ? four : two).film.radiance(x, y));
    }
  }
  EXPECT_GT(with_two, 0);
  EXPECT_GT(with_four, 0);

  Impatient at_once(0);
  const FrameResult nothing = scene.run({}, 2, at_once);
  EXPECT_TRUE(nothing.partial);
  EXPECT_EQ(nothing.samples, 0u);
  EXPECT_EQ(nothing.film.radiance(0, 0), Rgb(0));
}

/// Asks to stop while all chunks are grown, after the first one.
class StopsGrowth final : public Progress {
 public:
  void begin(std::string_view stage, double) override { growing_ = stage == "grow"; }
  void advance(double) override {
    if (growing_) stopped_ = true;
  }
  void end() override { growing_ = false; }
  bool cancelled() const override { return stopped_; }

 private:
  std::atomic<bool> growing_{false}, stopped_{false};
};

TEST(PathIntegrator, CountsWhatItGrewBeforeItWasStopped) {
  BusyScene scene;
  scene.render.bounds = BoundingStrategy::kNone;
  StopsGrowth progress;
  EXPECT_TRUE(scene.run({}, 1, progress).partial);
  EXPECT_EQ(scene.statistics.residency.expansions, 1);
  EXPECT_GT(scene.statistics.residency.cpu_s, 0);
  EXPECT_GT(scene.statistics.growth.strands, 0);
  EXPECT_LT(scene.statistics.growth.strands, 300);
}

TEST(PathIntegrator, MistakesOfASceneAreErrors) {
  PathScene wrong_fur(4, 4);
  ConeShellParams fibre;
  fibre.opacity = Field(0.5f);
  wrong_fur.add_fur(one_strand({{0, 0, 0}, {0, 1, 0}}, 0.1f), fibre);
  wrong_fur.materials[0] = LambertParams{};
  EXPECT_THROW(wrong_fur.run(), Error);

  PathScene wrong_skin(4, 4);
  wrong_skin.add_skin(sphere_mesh(1), ConeShellParams{});
  EXPECT_THROW(wrong_skin.run(), Error);

  PathScene no_memory(4, 4);
  RandomStrandOptions o;
  o.strands = 2000;
  no_memory.add_fur(random_strands(1, o), ConeShellParams{});
  no_memory.render.memory.bytes = 100000;
  try {
    no_memory.run();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
  }
}

/// What the film keeps beside light, for a strand and a skin whose answers are known.
TEST(PathIntegrator, SurfaceDataIsThatOfTheFrontMostSurface) {
  PathScene scene(32, 32);
  StrandArrays a = one_strand({{0, -2, 1}, {0, 2, 1}}, 0.3f).arrays();
  a.root_uv = {V2f(0.25f, 0.75f)};
  a.motion_keys = 2;
  const size_t one_key = a.points.size();
  for (size_t i = 0; i < one_key; ++i) a.points.push_back(a.points[i] + (i % 4 == 0 ? 0.1f : 0.0f));
  scene.add_fur(Strands(std::move(a)), diffuse_fibre(Rgb(0.5f)));
  scene.add_skin(sphere_mesh(0.9f), LambertParams{});
  scene.add_sky(Rgb(1));
  scene.camera.shutter = V2f(0, 0.5f);
  scene.camera.fov = 16.0f;
  scene.render.samples = 16;
  const FrameResult result = scene.run();

  const VisibleSurface& strand = result.film.surface(16, 16);
  EXPECT_NEAR(strand.depth, 9, 1e-3f);
  EXPECT_NEAR(std::abs(strand.tangent.y), 1, 1e-5f);
  EXPECT_NEAR(strand.normal.length(), 1, 1e-5f);
  EXPECT_GT(strand.normal.z, 0.5f);
  EXPECT_EQ(strand.id, 7u);
  EXPECT_NEAR(strand.root_uv.x, 0.25f, 0.5f / 65535);  // as finely as strands keep it
  EXPECT_NEAR(strand.root_uv.y, 0.75f, 0.5f / 65535);
  // 0.1 units in half a frame at depth 9 is 0.2 units to the next frame.
  const float pixels_per_unit = 32 / (2 * std::tan(8 * 3.14159265f / 180) * 9);
  EXPECT_NEAR(strand.forward.x, 0.2f * pixels_per_unit, 1e-2f);
  EXPECT_NEAR(strand.forward.y, 0, 1e-2f);

  const VisibleSurface& skin = result.film.surface(22, 16);
  EXPECT_EQ(skin.id, kNoStrand);
  EXPECT_EQ(skin.tangent, V3f(0));
  EXPECT_EQ(skin.forward, V2f(0));
  EXPECT_GT(skin.normal.x, 0.4f);
  EXPECT_GT(skin.depth, 9.1f);
}

/// The strand leans to its right, seen from the camera: its normal must do the same on both sides of its
/// axis.
TEST(PathIntegrator, NormalsOfFibresPointAwayFromTheirAxis) {
  PathScene scene(32, 32);
  scene.add_fur(one_strand({{0, -2, 0}, {0, 2, 0}}, 0.5f), diffuse_fibre(Rgb(0.5f)));
  scene.camera.fov = 10.0f;
  const FrameResult result = scene.run();
  EXPECT_LT(result.film.surface(8, 16).normal.x, -0.5f);
  EXPECT_GT(result.film.surface(23, 16).normal.x, 0.5f);
}

}  // namespace
}  // namespace pelage
