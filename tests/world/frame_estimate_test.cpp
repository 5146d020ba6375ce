// SPDX-License-Identifier: Apache-2.0
// The estimate of a frame against what its render charges and measures. tests/cli/estimate_test.py compares
// whole processes.
#include "render/frame_estimate.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "render/frame/skin_shadows.h"
#include "tests/support/quiet_job.h"
#include "tests/world/small_scene.h"
#include "world/world.h"

namespace pelage {
namespace {

class FrameEstimateTest : public testing::Test {
 protected:
  using Overrides = std::vector<Override>;

  FrameEstimate estimate(const Overrides& overrides, std::optional<PixelBox> region = {}) {
    const SceneDescription scene = load_scene(scene_.path("scene.yaml"), overrides);
    MemoryLedger ledger;
    QuietJob job(2, ledger);
    const std::unique_ptr<Assets> assets = load_assets(scene, job);
    const World world = compose(scene, *assets, 1, job);
    return estimate_frame(world.scene, job, region);
  }

  struct Rendered {
    int64_t film = 0, writing = 0, chunks = 0, count = 0;
  };
  Rendered rendered(const Overrides& overrides) {
    const SceneDescription scene = load_scene(scene_.path("scene.yaml"), overrides);
    MemoryLedger ledger;
    QuietJob job(2, ledger);
    const std::unique_ptr<Assets> assets = load_assets(scene, job);
    const World world = compose(scene, *assets, 1, job);
    const FrameResult result = render(world, job);
    Rendered found;
    found.film = ledger.current(MemoryTag::kFilm);
    write_frame(scene_.path("a.exr"), world, result, 0, job);
    found.writing = ledger.peak(MemoryTag::kFilm) - found.film;
    found.chunks = static_cast<int64_t>(result.statistics.residency.working_set_bytes);
    found.count = result.statistics.growth.chunks;
    return found;
  }

  SmallScene scene_;
};

TEST_F(FrameEstimateTest, FilmAndWritingAreExact) {
  for (const char* image : {"{width: 24, height: 16}", "{width: 200, height: 90, light_layers: false}"}) {
    const Overrides overrides{{"image", image}};
    const FrameEstimate estimated = estimate(overrides);
    const Rendered real = rendered(overrides);
    EXPECT_EQ(estimated.film_bytes, real.film) << image;
    EXPECT_EQ(estimated.writing_bytes, real.writing) << image;
    EXPECT_EQ(estimated.chunks, real.count) << image;
  }
}

TEST_F(FrameEstimateTest, ChunksAreNearThoseOfTheRender) {
  for (const char* accel : {"fur", "embree"}) {
    // Leaves of many sizes: more chunks than are grown for the estimate.
    const Overrides overrides{{"grooms.coat.strands", "20000"},
                              {"grooms.coat.leaf_strands", "300"},
                              {"render.accel", accel},
                              {"render.samples", "8"}};
    const FrameEstimate estimated = estimate(overrides);
    const Rendered real = rendered(overrides);
    ASSERT_GT(real.count, 60);
    // Above: chunks that no ray reached, and those that threads grow meanwhile.
    EXPECT_GT(static_cast<double>(estimated.chunk_bytes), 0.95 * static_cast<double>(real.chunks)) << accel;
    EXPECT_LT(static_cast<double>(estimated.chunk_bytes), 1.5 * static_cast<double>(real.chunks)) << accel;
    EXPECT_TRUE(estimated.fits);
  }
}

/// Remembers the names of stages.
class Stages final : public Progress {
 public:
  void begin(std::string_view stage, double) override { names.insert(std::string(stage)); }
  void advance(double) override {}
  void end() override {}
  bool cancelled() const override { return false; }
  std::set<std::string> names;
};

TEST_F(FrameEstimateTest, NoChunkIsBounded) {
  const SceneDescription scene = load_scene(scene_.path("scene.yaml"));
  MemoryLedger ledger;
  Stages stages;
  const Workers workers(2);
  const Job job{workers, ledger, stages};
  const std::unique_ptr<Assets> assets = load_assets(scene, job);
  const World world = compose(scene, *assets, 1, job);
  estimate_frame(world.scene, job, {});
  for (const char* stage : {"bound", "grow"})
    EXPECT_FALSE(stages.names.contains(stage)) << "boxes of a crowd take most of the time of an estimate";
  render(world, job);
  EXPECT_TRUE(stages.names.contains("grow"));
}

TEST_F(FrameEstimateTest, ABudgetLimitsChunks) {
  const Overrides overrides{{"grooms.coat.strands", "200000"}, {"render.memory", "32M"}};
  const FrameEstimate estimated = estimate(overrides);
  EXPECT_FALSE(estimated.fits);
  EXPECT_LE(estimated.chunk_bytes, int64_t{32} << 20);
  try {
    estimate({{"render.memory", "100K"}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
  }
}

TEST_F(FrameEstimateTest, ARegionHasASmallerFilm) {
  const Overrides overrides{{"image", "{width: 320, height: 160}"}};
  const FrameEstimate whole = estimate(overrides), region = estimate(overrides, PixelBox{0, 0, 160, 160});
  EXPECT_LT(region.film_bytes, whole.film_bytes);
  EXPECT_LT(region.tracing_cpu_s, whole.tracing_cpu_s);
  EXPECT_EQ(region.chunks, whole.chunks);
}

TEST_F(FrameEstimateTest, SkinBallsAreThoseOfTheRender) {
  const SceneDescription scene = load_scene(scene_.path("scene.yaml"), {{"render.skin_ball", "exact"}});
  MemoryLedger ledger;
  QuietJob job(2, ledger);
  const std::unique_ptr<Assets> assets = load_assets(scene, job);
  const World world = compose(scene, *assets, 1, job);
  const ShadowEstimate estimated = estimate_shadows(world.scene, job);
  const int64_t before = ledger.current(MemoryTag::kSkins);
  const SkinShadows shadows(world.scene, job);
  EXPECT_GT(estimated.held_bytes, 0);  // cubes are closed
  EXPECT_EQ(estimated.held_bytes, ledger.current(MemoryTag::kSkins) - before);
  EXPECT_GT(estimated.making_bytes, 0);
}

TEST_F(FrameEstimateTest, ThePeakIsThatOfTheLargestPhase) {
  FrameEstimate e;
  e.scene_bytes = 100;
  e.film_bytes = 10;
  e.chunk_bytes = 50;
  e.box_bytes = 1;
  e.writing_bytes = 20;
  EXPECT_EQ(e.peak_bytes(), 161);
  e.writing_bytes = 70;
  EXPECT_EQ(e.peak_bytes(), 180);
  e.measuring_bytes = 90;
  EXPECT_EQ(e.peak_bytes(), 201);
  e.shadows.held_bytes = 13;
  e.chunk_bytes = 80;
  EXPECT_EQ(e.peak_bytes(), 204);
  e.shadows.making_bytes = 99;
  EXPECT_EQ(e.peak_bytes(), 210);
  e.preparing_bytes = 500;
  EXPECT_EQ(e.peak_bytes(), 500);
}

}  // namespace
}  // namespace pelage
