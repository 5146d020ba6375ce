// SPDX-License-Identifier: Apache-2.0
#include "world/statistics.h"

#include <gtest/gtest.h>

#include "render/frame/frame_statistics.h"

namespace pelage {
namespace {

FrameResult frame(MemoryLedger& ledger) { return {.film = Film(1, 1, FilmLayers(), ledger)}; }

TEST(Statistics, SumWhatFramesCounted) {
  MemoryLedger ledger;
  FrameResult result = frame(ledger);
  result.statistics.growth = {.chunks = 2, .strands = 30, .area = {.chunks = 5, .parts = 4}};
  result.statistics.residency.expansions = 6;
  result.statistics.residency.waited_s = 0.5;
  result.statistics.reads = {.chunks = 1, .bytes = 100};
  result.statistics.trace = {.box_tests = 40, .chunk_visits = 20};
  result.statistics.rays = {.camera = 7, .shadow = 8, .indirect = 9};
  result.statistics.cpu_s = {.camera_rays = 1, .shadow_rays = 2, .indirect_rays = 3, .shading = 4};
  result.statistics.residency.cpu_s = 0.25;
  result.statistics.samples_rejected = 1;
  result.statistics.gather_points = {.count = 2, .samples = 50};
  result.statistics.reflections = {.cells = 3, .paths = 4, .lookups = 6, .found = 5};
  result.statistics.stages_s = {{"render", 2.0}};
  Statistics run;
  for (int i = 0; i < 3; ++i) run.add(result, 1, 1.0 / 3);
  const FrameStatistics& frames = run.frames;
  EXPECT_EQ(frames.growth.chunks, 6);
  EXPECT_EQ(frames.growth.strands, 90);
  EXPECT_EQ(frames.growth.area.chunks, 15);
  EXPECT_EQ(frames.growth.area.parts, 12);
  EXPECT_EQ(frames.residency.expansions, 18);
  EXPECT_EQ(frames.residency.waited_s, 1.5);
  EXPECT_EQ(frames.reads.chunks, 3);
  EXPECT_EQ(frames.reads.bytes, 300);
  EXPECT_EQ(frames.trace.box_tests, 120);
  EXPECT_EQ(frames.trace.chunk_visits, 60);
  EXPECT_EQ(frames.rays.camera, 21);
  EXPECT_EQ(frames.rays.shadow, 24);
  EXPECT_EQ(frames.rays.indirect, 27);
  EXPECT_EQ(frames.rays.total(), 72);
  EXPECT_EQ(frames.cpu_s.camera_rays, 3);
  EXPECT_EQ(frames.cpu_s.shadow_rays, 6);
  EXPECT_EQ(frames.cpu_s.indirect_rays, 9);
  EXPECT_EQ(frames.cpu_s.shading, 12);
  EXPECT_EQ(frames.residency.cpu_s, 0.75);
  EXPECT_EQ(frames.samples_rejected, 3);
  EXPECT_EQ(frames.gather_points.count, 6);
  EXPECT_EQ(frames.gather_points.samples, 150);
  EXPECT_EQ(frames.reflections.cells, 9);
  EXPECT_EQ(frames.reflections.paths, 12);
  EXPECT_EQ(frames.reflections.lookups, 18);
  EXPECT_EQ(frames.reflections.found, 15);
  EXPECT_EQ(frames.stages_s.at("render"), 6);
}

TEST(Statistics, KeepTheFirstPixelTheMeanAndTheWorstFrame) {
  MemoryLedger ledger;
  Statistics run;
  FrameResult first = frame(ledger), second = frame(ledger);
  first.first_tile_s = 0.25;
  first.mean_samples = 10;
  first.noise = 0.5;
  first.clamped_fraction = 0.125;
  first.statistics.residency.working_set_bytes = 70;
  first.time_limited = true;
  second.first_tile_s = 4;
  second.mean_samples = 30;
  second.noise = 0.25;
  second.clamped_fraction = 0.5;
  second.statistics.residency.working_set_bytes = 50;
  run.add(first, 1, 0.5);
  run.add(second, 8, 0.5);
  EXPECT_EQ(run.first_pixel_s, 1.25);
  EXPECT_EQ(run.samples_per_pixel, 20);
  EXPECT_EQ(run.noise, 0.5);
  EXPECT_EQ(run.clamped_fraction, 0.5);
  EXPECT_TRUE(run.time_limited);
  EXPECT_EQ(run.frames.residency.working_set_bytes, 70);
}

}  // namespace
}  // namespace pelage
