// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/cache_fill.h"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "render/frame/frame_geometry.h"
#include "tests/render/path/path_scene.h"

namespace pelage {
namespace {

/// Fills caches of a small ball of pale fur by plans of the tests, and reads them.
class CacheFillTest : public ::testing::Test {
 protected:
  CacheFillTest() {
    std::vector<std::unique_ptr<Light>> lights;
    EnvironmentLightParams sky;
    lights.push_back(make_light("sky", sky, 1, textures_, ledger_));
    PathScene parts(24, 24);
    parts.camera.fov = 16;
    parts.add_fur(furball(300, 0.5f, 0.02f), diffuse_fibre(Rgb(0.9f)));
    parts.add_skin(sphere_mesh(0.9f), LambertParams{});
    parts.render.samples = 8;
    parts.render.bounces = 6;
    parts.render.gather.cache_paths = 12;
    scene_.emplace(RenderScene{std::move(parts.fur), parts.skins, parts.materials,
                               LightSet(std::move(lights)), Camera(parts.camera, 1, 24, 24), parts.image,
                               parts.render});
    geometry_ = FrameGeometry::make(*scene_, job(), statistics_);
  }
  Job job() { return {workers_, ledger_, progress_}; }

  struct Filled {
    std::vector<Rgb> answers;  ///< of find() for the second surfaces of paths; -1 where there is none
    ReflectionStatistics counts;
  };
  Filled fill(const CachePlan& plan) {
    CacheFill fill(*scene_, geometry_->accel(), false, {}, {plan, {}});
    std::optional<ReflectionCache> cache;
    fill.run(job(), clock_, cache);
    FrameStatistics statistics;
    fill.add_to(statistics);
    Filled filled{{}, statistics.reflections};
    const FrameShading shading(*scene_, {});
    const CameraSamples camera(*scene_, geometry_->accel(), false);
    SampleScratch scratch;
    for (int i = 0; i < 24 * 24 * 4; ++i) {
      const int x = i % 24, y = i / 24 % 24;
      const auto sample = static_cast<uint32_t>(i / 576);
      SampleStream stream = camera.stream(x, y, sample);
      const CameraSample from = camera.sample(x, y, sample, stream);
      const Hit hit = scratch.closest(RayKind::kCamera, geometry_->accel(), from.ray);
      if (!hit) continue;
      const ScatterPoint point = shading.scatter_point(from.ray, hit, scratch.thread.hit_geometry);
      const auto drawn = point.sample(stream.next3d());
      if (!drawn) continue;
      Ray ray;
      ray.origin = point.start(drawn->wi);
      ray.direction = drawn->wi;
      if (!point.can_hit_own_strand()) ray.start = hit.start;
      const Hit second = scratch.closest(RayKind::kIndirect, geometry_->accel(), ray);
      if (!second) continue;
      (void)shading.scatter_point(ray, second, scratch.thread.hit_geometry);
      const auto light = cache->find(ray, second, scratch.thread.hit_geometry);
      filled.answers.push_back(light ? light[0] : Rgb(-1));
    }
    return filled;
  }

  Workers workers_{2};
  MemoryLedger ledger_;
  NoProgress progress_;
  Stopwatch clock_;
  TextureLibrary textures_{ledger_};
  FrameStatistics statistics_;
  std::optional<RenderScene> scene_;
  std::unique_ptr<FrameGeometry> geometry_;
};

TEST_F(CacheFillTest, SlicesAndBatchesChangeNoAnswer) {
  const CachePlan plan = CachePlan::with_slices(*scene_, 1);
  const Filled whole = fill(plan);
  EXPECT_EQ(whole.counts.slices, 1);
  const auto cells = static_cast<size_t>(whole.counts.cells);
  ASSERT_GT(cells, 1000u);
  int answered = 0;
  for (const Rgb& answer : whole.answers) answered += answer.x >= 0 ? 1 : 0;
  EXPECT_GT(answered, 100);
  for (const uint32_t slices : {2u, 5u}) {
    CachePlan small = plan;
    small.slices = slices;
    small.batch = 1;
    const Filled sliced = fill(small);
    EXPECT_EQ(sliced.counts.slices, slices == 2 ? 2 : 6) << "5 slices leave a rest";
    EXPECT_EQ(sliced.counts.cells, whole.counts.cells);
    EXPECT_EQ(sliced.counts.paths, whole.counts.paths);
    EXPECT_EQ(sliced.answers, whole.answers);
  }
  CachePlan tight = plan;
  tight.slices = 2;
  tight.room = cells / 4;  // half of the cells do not fit
  const Filled halved = fill(tight);
  EXPECT_GT(halved.counts.slices, 4);
  EXPECT_LT(halved.counts.slices, 100);
  EXPECT_EQ(halved.answers, whole.answers);
}

TEST_F(CacheFillTest, TheSameCellsAreDroppedWithAnySlices) {
  CachePlan plan = CachePlan::with_slices(*scene_, 1);
  const Filled all = fill(plan);
  plan.max_cells = static_cast<size_t>(all.counts.cells / 2);
  plan.room = plan.max_cells;
  const Filled whole = fill(plan);
  EXPECT_LE(whole.counts.cells, all.counts.cells / 2);
  EXPECT_NE(whole.answers, all.answers);
  for (const uint32_t slices : {2u, 4u}) {
    plan.slices = slices;
    const Filled sliced = fill(plan);
    EXPECT_EQ(sliced.counts.cells, whole.counts.cells);
    EXPECT_EQ(sliced.answers, whole.answers);
  }
}

/// In a closed room, no path ends early.
TEST(CacheFill, APathDividesAtItsThirdSurfaceAndTracesNoShadowRaysBefore) {
  PathScene room(16, 16);
  room.add_skin(sphere_mesh(100), LambertParams{});  // around the camera
  SphereLightParams lamp;
  lamp.radius = 0.5f;
  TextureLibrary textures(room.ledger);
  std::vector<std::unique_ptr<Light>> lights;
  lights.push_back(make_light("lamp", lamp, 1, textures, room.ledger));
  RenderScene scene{
      {},         room.skins, room.materials, LightSet(std::move(lights)), Camera(room.camera, 1, 16, 16),
      room.image, room.render};
  scene.render.samples = 4;
  PathOptions options;
  options.direct = DirectTechniques::kLightsOnly;
  options.roulette = false;
  const Workers workers(1);
  NoProgress progress;
  const Job job{workers, room.ledger, progress};
  const auto rays = [&](int bounces) {
    scene.render.bounces = bounces;
    FrameStatistics statistics;
    const auto geometry = FrameGeometry::make(scene, job, statistics);
    CacheFill fill(scene, geometry->accel(), false, options, {CachePlan::with_slices(scene, 1), {}});
    std::optional<ReflectionCache> cache;
    fill.run(job, Stopwatch(), cache);
    statistics = {};
    fill.add_to(statistics);
    return statistics.rays;
  };
  const RayStatistics short_paths = rays(2), long_paths = rays(4);
  ASSERT_GT(short_paths.camera, 100);
  EXPECT_EQ(short_paths.indirect, 2 * short_paths.camera);
  EXPECT_EQ(short_paths.shadow, 0);
  EXPECT_EQ(long_paths.indirect, (2 + 2 * 2) * long_paths.camera) << "two branches of two rays";
  EXPECT_GT(long_paths.shadow, long_paths.camera);
}

}  // namespace
}  // namespace pelage
