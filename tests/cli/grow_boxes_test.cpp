// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <regex>

#include <gtest/gtest.h>

#include "base/error.h"
#include "cli/commands.h"
#include "tests/world/small_scene.h"

namespace pelage {
namespace {

class GrowBoxesTest : public testing::Test {
 protected:
  std::string grow(std::vector<Override> overrides) {
    Options options;
    options.command = Command::kGrow;
    options.input = scene_.path("scene.yaml");
    options.progress = ProgressStyle::kQuiet;
    options.overrides = {{"grooms.coat.cache", "{directory: '" + scene_.path("cache") + "', freeze: length}"},
                         {"grooms.coat.leaf_strands", "100"}};
    options.overrides.insert(options.overrides.end(), overrides.begin(), overrides.end());
    testing::internal::CaptureStdout();
    EXPECT_EQ(run_grow(options), 0);
    return testing::internal::GetCapturedStdout();
  }
  // What was said of a frame: chunks, and how many of them were remembered.
  static std::pair<int, int> boxes(const std::string& said, int frame) {
    std::smatch match;
    const std::regex line("frame " + std::to_string(frame) + ": boxes of (\\d+) chunks, (\\d+) read");
    if (!std::regex_search(said, match, line)) return {0, 0};
    return {std::stoi(match[1]), std::stoi(match[2])};
  }
  size_t box_files() const {
    size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(scene_.path("cache")))
      count += entry.path().filename().string().starts_with("boxes-");
    return count;
  }

  SmallScene scene_;
};

TEST_F(GrowBoxesTest, FramesAreMeasuredOnceAndRememberedThen) {
  const std::string first = grow({{"frames", "'1-2'"}});
  const auto [chunks, remembered] = boxes(first, 1);
  EXPECT_GE(chunks, 4) << first;
  EXPECT_EQ(remembered, 0) << first;
  EXPECT_EQ(boxes(first, 2), std::pair(chunks, 0)) << first;
  EXPECT_EQ(box_files(), 2u);
  const std::string again = grow({{"frames", "'2-3'"}});
  EXPECT_EQ(boxes(again, 2), std::pair(chunks, chunks)) << again;
  EXPECT_EQ(boxes(again, 3), std::pair(chunks, 0)) << again;
  EXPECT_EQ(box_files(), 3u);
}

TEST_F(GrowBoxesTest, NothingIsMeasuredForStrategiesThatStateTheirBoxes) {
  for (const char* strategy : {"none", "conservative"}) {
    EXPECT_EQ(grow({{"render.bounds", strategy}}).find("boxes"), std::string::npos);
  }
  EXPECT_EQ(box_files(), 0u);
}

TEST_F(GrowBoxesTest, CoatsWithoutACacheAreLeftOut) {
  EXPECT_EQ(grow({{"grooms.coat.cache", "null"}}).find("boxes"), std::string::npos);
}

// Filling caches ahead of time relies on the exit code.
TEST_F(GrowBoxesTest, FailsWhenNothingWasKept) {
  try {
    grow({{"grooms.coat.cache", "{directory: /proc/none, freeze: length}"}});
    ADD_FAILURE() << "kept in /proc";
  } catch (const Error& error) {
    testing::internal::GetCapturedStdout();
    EXPECT_EQ(error.kind(), ErrorKind::kFailed);
    EXPECT_STREQ(error.what(), "cannot write the cache of groom 'coat'");
  }
}

}  // namespace
}  // namespace pelage
