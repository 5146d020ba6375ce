// SPDX-License-Identifier: Apache-2.0
#include "world/statistics_json.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/temporary_folder.h"

namespace pelage {
namespace {

TEST(StatsJson, HoldsWhatIsPromised) {
  Statistics statistics;
  statistics.process.wall_s = 1.5;
  statistics.process.peak_rss_bytes = int64_t(1) << 40;
  statistics.frames.rays = {.camera = 3, .shadow = 5, .indirect = 0};
  statistics.frames.gather_points = {.count = 11, .samples = 40};
  statistics.frames.reflections = {.cells = 12, .paths = 13, .lookups = 15, .found = 14};
  statistics.process.memory_bytes = {{"film", 7}};
  statistics.stages_s = {{"grow", 0.25}, {"read", 1}};
  statistics.frames.stages_s = {{"grow", 0.5}, {"render", 2}};
  const auto json = nlohmann::json::parse(statistics_json(statistics));
  EXPECT_EQ(json.at("schema"), 1);
  EXPECT_EQ(json.at("wall_s"), 1.5);
  EXPECT_EQ(json.at("peak_rss_bytes"), int64_t(1) << 40);
  EXPECT_EQ(json.at("rays").at("shadow"), 5);
  EXPECT_EQ(json.at("gather_points"), 11);
  EXPECT_EQ(json.at("reflection_cells"), 12);
  EXPECT_EQ(json.at("reflection_paths"), 13);
  EXPECT_EQ(json.at("reflection_lookups"), 15);
  EXPECT_EQ(json.at("reflections_found"), 14);
  EXPECT_EQ(json.at("gather_point_samples"), 40);
  EXPECT_EQ(json.at("memory_bytes").at("film"), 7);
  EXPECT_EQ(json.at("stages_s"), nlohmann::json({{"grow", 0.75}, {"read", 1.0}, {"render", 2.0}}));
  for (const char* name : {"cpu_s",
                           "baseline_rss_bytes",
                           "working_set_bytes",
                           "strands_described",
                           "strands_unique",
                           "strands_generated",
                           "characters",
                           "characters_in_frame",
                           "chunks",
                           "expansions",
                           "reexpansions",
                           "false_expansions",
                           "samples_rejected",
                           "indirect",
                           "clamped_fraction",
                           "peak_anonymous_bytes",
                           "baseline_anonymous_bytes",
                           "unexplained_bytes",
                           "strands_dropped",
                           "strands_repaired",
                           "version"}) {
    EXPECT_TRUE(json.contains(name)) << name;
  }
}

TEST(StatsJson, DividesCpuTime) {
  Statistics statistics;
  statistics.process.cpu_s = 20;
  EXPECT_TRUE(nlohmann::json::parse(statistics_json(statistics)).at("cpu_s_by").empty()) << "no rays";
  statistics.frames.rays.camera = 1;
  statistics.frames.cpu_s = {.camera_rays = 1, .shadow_rays = 2, .indirect_rays = 3, .shading = 4};
  statistics.frames.residency.cpu_s = 5;
  const auto json = nlohmann::json::parse(statistics_json(statistics));
  const std::map<std::string, double> parts = json.at("cpu_s_by");
  const std::map<std::string, double> expected{{"camera_rays", 1}, {"shadow_rays", 2}, {"indirect_rays", 3},
                                               {"shading", 4},     {"growth", 5},      {"other", 5}};
  EXPECT_EQ(parts, expected);
}

TEST(StatsJson, HoldsATimelineWhenThereIsOne) {
  EXPECT_FALSE(nlohmann::json::parse(statistics_json({})).contains("timeline"));
  Statistics statistics;
  MemorySample sample;
  sample.seconds = 0.5;
  sample.resident = {300, 200};
  sample.tags[static_cast<size_t>(MemoryTag::kFilm)] = 70;
  statistics.process.timeline = {{}, sample};
  const auto json = nlohmann::json::parse(statistics_json(statistics));
  const auto& columns = json.at("timeline_columns");
  ASSERT_EQ(json.at("timeline").size(), 2u);
  const auto& row = json.at("timeline")[1];
  ASSERT_EQ(row.size(), columns.size());
  EXPECT_EQ(columns[0], "seconds");
  EXPECT_EQ(row[0], 0.5);
  EXPECT_EQ(columns[1], "rss_anon_bytes");
  EXPECT_EQ(row[1], 300);
  EXPECT_EQ(columns[2], "rss_file_bytes");
  EXPECT_EQ(row[2], 200);
  const auto film = std::find(columns.begin(), columns.end(), "film") - columns.begin();
  EXPECT_EQ(row[static_cast<size_t>(film)], 70);
}

TEST(StatsJson, IsWrittenWhole) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "deep" / "stats.json";
  write_statistics(path, {});
  EXPECT_EQ(read_file(path), statistics_json({}));
}

}  // namespace
}  // namespace pelage
