// SPDX-License-Identifier: Apache-2.0
// leaf_strands changes no pixel, of coats from a cache too; and what is in a cache is found again.
#include <filesystem>

#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "cli/commands.h"
#include "lab/pictures/picture_difference.h"

namespace pelage {
namespace {

class LeafStrandsTest : public testing::Test {
 protected:
  Options options_for(Command command, const std::string& leaf_strands) const {
    Options options;
    options.command = command;
    options.input = (std::filesystem::path(PELAGE_SOURCE_DIR) / "examples" / "colony_small.yaml").string();
    options.progress = ProgressStyle::kQuiet;
    options.overrides = {{"image.width", "160"},
                         {"image.height", "90"},
                         {"render.samples", "1"},
                         {"grooms.under.strands", "900"},
                         {"grooms.guard.strands", "400"}};
    for (const char* groom : {"under", "guard", "whiskers"}) {
      const std::string prefix = std::string("grooms.") + groom;
      options.overrides.push_back({prefix + ".cache.directory", (folder_.path() / "cache").string()});
      options.overrides.push_back({prefix + ".leaf_strands", leaf_strands});
    }
    return options;
  }

  std::string render(const std::string& leaf_strands, const std::string& run) const {
    Options options = options_for(Command::kRender, leaf_strands);
    options.output = (folder_.path() / (leaf_strands + run + ".exr")).string();
    EXPECT_EQ(run_render(options), 0);
    return options.output;
  }

  TemporaryFolder folder_;
};

// The first groom of the first run is named before any texture has been read, and its libraries loaded.
TEST_F(LeafStrandsTest, EveryCacheIsFreshTheSecondTime) {
  const Options options = options_for(Command::kGrow, "500");
  testing::internal::CaptureStdout();
  EXPECT_EQ(run_grow(options), 0);
  testing::internal::GetCapturedStdout();
  testing::internal::CaptureStdout();
  EXPECT_EQ(run_grow(options), 0);
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_EQ(said.find("stale"), std::string::npos) << said;
  EXPECT_NE(said.find("whiskers: fresh"), std::string::npos) << said;
}

TEST_F(LeafStrandsTest, ChangesNoPixelOfACachedCoat) {
  const std::string first = render("500", "cold");
  for (const auto& [leaf_strands, run] : {std::pair("500", "warm"), std::pair("300", "cold"),
                                          std::pair("300", "warm"), std::pair("41", "cold")}) {
    const auto difference = compare_picture_files(first, render(leaf_strands, run));
    ASSERT_TRUE(difference) << leaf_strands << run;
    EXPECT_EQ(difference->differing, 0) << leaf_strands << run;
  }
}

}  // namespace
}  // namespace pelage
