// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/cache_plan.h"

#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/render/gather/key_scene.h"

namespace pelage {
namespace {

/// A picture without lights of so many pixels.
RenderScene picture(int width, int height, int samples) {
  RenderScene scene = key_scene::make({});
  scene.image.width = width;
  scene.image.height = height;
  scene.render.samples = samples;
  return scene;
}

TEST(CachePlan, MoreSlicesNeedLessMemoryForTheSameCells) {
  const RenderScene scene = picture(1920, 1080, 64);
  int64_t before = INT64_MAX;
  for (uint32_t slices = 1; slices <= CachePlan::kMostSlices; slices *= 2) {
    const CachePlan plan = CachePlan::with_slices(scene, slices);
    EXPECT_EQ(plan.max_cells, size_t{1} << 20);
    EXPECT_GE(plan.room, plan.max_cells / slices);
    EXPECT_GE(plan.batch, 1u);
    EXPECT_LT(plan.bytes, before);
    before = plan.bytes;
  }
}

TEST(CachePlan, TakesTheFewestSlicesThatFit) {
  RenderScene scene = picture(640, 480, 16);
  const int64_t whole = CachePlan::with_slices(scene, 1).bytes;
  MemoryLedger ledger;
  EXPECT_EQ(CachePlan::fitting(scene, ledger).slices, 1u);
  scene.render.gather.memory.bytes = static_cast<uint64_t>(whole);
  EXPECT_EQ(CachePlan::fitting(scene, ledger).slices, 1u);
  for (const double part : {0.5, 0.25}) {
    scene.render.gather.memory.bytes = static_cast<uint64_t>(part * static_cast<double>(whole));
    const CachePlan plan = CachePlan::fitting(scene, ledger);
    EXPECT_GT(plan.slices, 1u);
    EXPECT_LE(plan.bytes, static_cast<int64_t>(scene.render.gather.memory.bytes));
    EXPECT_GT(CachePlan::with_slices(scene, plan.slices / 2).bytes,
              static_cast<int64_t>(scene.render.gather.memory.bytes));
  }
}

TEST(CachePlan, TakesAQuarterOfWhatIsLeftIfSlicesAvoidMore) {
  const RenderScene scene = picture(640, 480, 16);
  const int64_t whole = CachePlan::with_slices(scene, 1).bytes;
  MemoryLedger ledger;
  ledger.set_limit(static_cast<uint64_t>(4 * whole));
  EXPECT_EQ(CachePlan::fitting(scene, ledger).slices, 1u);
  const MemoryCharge used(ledger, MemoryTag::kSkins, whole / 2);
  EXPECT_GT(CachePlan::fitting(scene, ledger).slices, 1u);
}

TEST(CachePlan, ARefusalNamesWhatSuffices) {
  RenderScene scene = picture(640, 480, 16);
  MemoryLedger ledger;
  scene.render.gather.memory.bytes = 1 << 20;
  try {
    (void)CachePlan::fitting(scene, ledger);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
    const std::string text = error.what();
    const size_t at = text.find("; ");
    ASSERT_NE(at, std::string::npos) << text;
    scene.render.gather.memory.bytes = std::stoull(text.substr(at + 2)) << 20;
  }
  EXPECT_EQ(CachePlan::fitting(scene, ledger).slices, CachePlan::kMostSlices);
}

}  // namespace
}  // namespace pelage
