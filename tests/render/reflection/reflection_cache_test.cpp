// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/render/film/film_picture.h"
#include "tests/render/gather/gather_scene.h"

namespace pelage::reflection_cache_test {
namespace {

struct CachedScene : GatherScene {
  CachedScene() {
    render.bounces = 5;
    render.gather.cache = true;
    render.gather.cache_paths = 40;  // enough to fill the cells of so small a picture
  }
};

void expect_same(const Film& a, const Film& b) {
  const ExrImage one = picture_of(a), other = picture_of(b);
  ASSERT_EQ(one.channels.size(), other.channels.size());
  for (size_t i = 0; i < one.channels.size(); ++i)
    EXPECT_EQ(one.channels[i].pixels, other.channels[i].pixels) << one.channels[i].name;
}

TEST(ReflectionCache, OneAndManyThreadsGiveTheSameFilm) {
  CachedScene scene;
  const FrameResult one = scene.run({}, 1);
  const ReflectionStatistics first = scene.statistics.reflections;
  expect_same(one.film, scene.run({}, 4).film);
  EXPECT_GT(first.cells, 0);
  EXPECT_GT(first.found, 0);
  EXPECT_EQ(scene.statistics.reflections.cells, 2 * first.cells);
  EXPECT_EQ(scene.statistics.reflections.found, 2 * first.found);
}

TEST(ReflectionCache, ARegionHasThePixelsOfThePicture) {
  CachedScene scene;
  const FrameResult whole = scene.run();
  FrameOptions options;
  options.region = PixelBox{8, 6, 20, 18};
  NoProgress progress;
  const FrameResult part = scene.run_frame(options, 2, progress);
  const PixelBox film = part.window.film;
  for (int y = 6; y < 18; ++y) {
    for (int x = 8; x < 20; ++x)
      EXPECT_EQ(part.film.radiance(x - film.x0, y - film.y0), whole.film.radiance(x, y)) << x << ", " << y;
  }
}

TEST(ReflectionCache, IsUsedFromThreeBouncesOnAndInCrowdsFromEight) {
  constexpr size_t kFew = RenderParams::kFewSkins, kMany = kFew + 1;
  RenderParams params;
  const auto uses = [&](int bounces, size_t skins) {
    params.bounces = bounces;
    return params.uses_cache(skins);
  };
  EXPECT_FALSE(uses(2, kFew));
  EXPECT_TRUE(uses(3, kFew));
  EXPECT_FALSE(uses(7, kMany));
  EXPECT_TRUE(uses(8, kMany));
  params.gather.cache = true;
  EXPECT_TRUE(uses(1, kMany));
  EXPECT_FALSE(uses(0, kFew));
  params.gather.reuse = false;
  EXPECT_FALSE(uses(8, kFew));
  params.gather = {};
  params.gather.cache = false;
  EXPECT_FALSE(uses(8, kFew));
}

TEST(ReflectionCache, AnswersMostPathsInPaleFur) {
  PathScene scene(24, 24);
  scene.camera.fov = 16;
  scene.add_fur(furball(2000, 0.5f, 0.02f), diffuse_fibre(Rgb(0.95f)));
  scene.add_sky(Rgb(1));
  scene.render.integrator = Integrator::kGather;
  scene.render.bounces = 12;
  scene.render.gather.cache_paths = 2;
  scene.render.gather.cache = false;
  scene.run();
  EXPECT_EQ(scene.statistics.reflections.lookups, 0);
  scene.render.gather.cache = true;
  scene.run();
  EXPECT_GT(scene.statistics.reflections.found, scene.statistics.reflections.lookups / 2);
}

/// Returns the number of a refusal that begins a part of its text: "; 3M suffices".
uint64_t sufficient_bytes(const Error& error) {
  const std::string text = error.what();
  return std::stoull(text.substr(text.find("; ") + 2)) << 20;
}

/// A picture that is large enough for several slices.
struct LargeCachedScene : CachedScene {
  LargeCachedScene() {
    image.width = 48;
    image.height = 36;
    render.samples = 2;
    render.gather.cache_paths = 40;
  }
};

/// Returns the least memory that suffices, as a refusal names it.
uint64_t least_memory() {
  LargeCachedScene scene;
  scene.render.gather.memory.bytes = 64 << 10;
  try {
    scene.run();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
    EXPECT_NE(std::string(error.what()).find("render.gather.memory"), std::string::npos) << error.what();
    EXPECT_EQ(scene.ledger.current(MemoryTag::kReflectionCache), 0);
    return sufficient_bytes(error);
  }
  ADD_FAILURE() << "not refused";
  return 0;
}

TEST(ReflectionCache, SlicesChangeNoPixel) {
  LargeCachedScene scene;
  const FrameResult whole = scene.run();
  const ReflectionStatistics first = scene.statistics.reflections;
  EXPECT_EQ(first.slices, 1);
  EXPECT_GT(first.found, 0);
  scene.render.gather.memory.bytes = least_memory();
  scene.statistics = {};
  expect_same(whole.film, scene.run({}, 4).film);
  const ReflectionStatistics& sliced = scene.statistics.reflections;
  EXPECT_GE(sliced.slices, 8);
  EXPECT_EQ(sliced.cells, first.cells);
  EXPECT_EQ(sliced.paths, first.paths);
  EXPECT_EQ(sliced.found, first.found);
}

TEST(ReflectionCache, WithoutReuseItIsNotUsed) {
  CachedScene scene;
  scene.render.gather.reuse = false;
  const FrameResult with = scene.run();
  EXPECT_EQ(scene.statistics.reflections.cells, 0);
  scene.render.gather.cache = false;
  expect_same(with.film, scene.run().film);
}

/// Stops as soon as the cache is being filled.
struct StopsFill final : Progress {
  void begin(std::string_view stage, double) override { filling = filling || stage == "reflection cache"; }
  void advance(double) override {}
  void end() override {}
  bool cancelled() const override { return filling; }
  bool filling = false;
};

TEST(ReflectionCache, AnInterruptedFillLeavesAnEmptyPicture) {
  CachedScene scene;
  StopsFill progress;
  const FrameResult result = scene.run({}, 1, progress);
  EXPECT_TRUE(result.partial);
  EXPECT_EQ(result.samples, 0u);
}

}  // namespace
}  // namespace pelage::reflection_cache_test
