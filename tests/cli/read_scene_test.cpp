// SPDX-License-Identifier: Apache-2.0
#include "cli/read_scene.h"

#include <fstream>

#include <gtest/gtest.h>

#include "base/temporary_folder.h"

namespace pelage {
namespace {

struct Warnings final : Progress {
  std::vector<std::string> lines;
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  bool cancelled() const override { return false; }
  void warn(std::string_view line) override { lines.emplace_back(line); }
};

TEST(ReadScene, WarnsOfOldNamesWithTheirPlaces) {
  const TemporaryFolder folder;
  RunOptions options;
  options.input = (folder.path() / "s.yaml").string();
  std::ofstream(options.input) << "pelage: 1\nrender:\n  lod: {turned_away: false}\n";
  options.overrides = {{"render.lod.least_share", "0.1"}};
  Warnings warnings;
  const SceneDescription scene = read_scene(options, warnings);
  EXPECT_FALSE(scene.render.lod.back_facing);
  EXPECT_EQ(warnings.lines, (std::vector<std::string>{
                                options.input + ":3:9: 'turned_away' is now called 'backfacing'",
                                "--set render.lod.least_share: 'least_share' is now called 'min_fraction'"}));
}

}  // namespace
}  // namespace pelage
