// SPDX-License-Identifier: Apache-2.0
// What the cache of reflections saves, and that it fits into any memory that suffices. CacheFillTest fills
// slices in smaller pictures.
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/render/reflection/cached_scene.h"

namespace pelage::reflection_cache_test {
namespace {

TEST(ReflectionMemory, AnswersMostPathsInPaleFur) {
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

TEST(ReflectionMemory, SlicesChangeNoPixel) {
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

}  // namespace
}  // namespace pelage::reflection_cache_test
