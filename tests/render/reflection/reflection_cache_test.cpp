// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include <gtest/gtest.h>

#include "tests/render/reflection/cached_scene.h"

namespace pelage::reflection_cache_test {
namespace {

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
