// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "base/error.h"
#include "cli/commands.h"
#include "geom/io/strand_file.h"
#include "tests/world/small_scene.h"

namespace pelage {
namespace {

class GrowExportTest : public testing::Test {
 protected:
  /// The file that `grow -o` writes for a picture of this width.
  std::filesystem::path grown(int width, bool lod) {
    Options options;
    options.command = Command::kGrow;
    options.input = scene_.path("scene.yaml");
    options.output = scene_.path(std::to_string(width) + (lod ? "-lod.hair" : ".hair"));
    options.progress = ProgressStyle::kQuiet;
    options.lod = lod;
    options.overrides = {{"image.width", std::to_string(width)},
                         {"image.height", std::to_string(width * 9 / 16)},
                         {"render.lod.enabled", "true"}};
    testing::internal::CaptureStdout();
    EXPECT_EQ(run_grow(options), 0);
    testing::internal::GetCapturedStdout();
    return options.output;
  }
  static size_t strands(const std::filesystem::path& file) {
    return read_strands(file).strands.strand_count();
  }

  SmallScene scene_;
};

TEST_F(GrowExportTest, WritesAllStrandsWhateverThePicturesSize) {
  for (const int width : {1280, 32}) EXPECT_EQ(strands(grown(width, false)), 400u) << width;
}

TEST_F(GrowExportTest, OneGroomOfTwoMayHaveColor) {
  // One of the two characters moves.
  scene_.write("two.yaml", R"(include: scene.yaml
grooms:
  red: {skin: still, strands: 30, operators: [{length: {value: 0.4}}, {color: {value: [1, 0, 0]}}]}
characters:
  post: {parts: [{skin: still, material: hide, grooms: {red: fur}}]}
)");
  Options options;
  options.command = Command::kGrow;
  options.input = scene_.path("two.yaml");
  options.output = scene_.path("two.hair");
  options.progress = ProgressStyle::kQuiet;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_grow(options), 0);
  testing::internal::GetCapturedStdout();
  const std::string warnings = testing::internal::GetCapturedStderr();
  EXPECT_NE(warnings.find("two.hair: strands of walker.coat have no color; the file says white"),
            std::string::npos)
      << warnings;
  const Strands strands = read_strands(options.output).strands;
  ASSERT_EQ(strands.strand_count(), 430u);
  const StrandAttribute* color = strands.find_attribute("color");
  ASSERT_NE(color, nullptr);
  EXPECT_EQ(std::count(color->values.begin(), color->values.end(), 0.0f) % 60, 0)
      << "red has no green and blue";
  EXPECT_GT(std::count(color->values.begin(), color->values.end(), 0.0f), 0);
}

TEST_F(GrowExportTest, GroomsNeedNoCharacter) {
  // Without characters, all grooms grow where their skins are; --groom grows one that no character wears.
  scene_.write("bare.yaml", R"(pelage: 1
skins: {still: {mesh: cube.obj}}
grooms:
  red: {skin: still, strands: 30, operators: [{length: {value: 0.4}}]}
  blue: {skin: still, strands: 20, operators: [{length: {value: 0.4}}]}
)");
  scene_.write("worn.yaml", R"(include: scene.yaml
grooms: {red: {skin: still, strands: 30, operators: [{length: {value: 0.4}}]}}
)");
  scene_.write("empty.yaml", R"(pelage: 1
skins: {still: {mesh: cube.obj}}
)");
  Options options;
  options.command = Command::kGrow;
  options.progress = ProgressStyle::kQuiet;
  options.output = scene_.path("bare.usda");
  const auto grow = [&](const char* scene, const char* groom) {
    options.input = scene_.path(scene);
    options.groom = groom;
    testing::internal::CaptureStdout();
    EXPECT_EQ(run_grow(options), 0);
    testing::internal::GetCapturedStdout();
    return strands(options.output);
  };
  EXPECT_EQ(grow("bare.yaml", ""), 50u);
  EXPECT_EQ(grow("bare.yaml", "blue"), 20u);
  EXPECT_EQ(grow("worn.yaml", "red"), 30u);
  EXPECT_EQ(grow("worn.yaml", ""), 400u);
  options.input = scene_.path("empty.yaml");
  options.groom.clear();
  options.output = scene_.path("none.usda");
  try {
    run_grow(options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              options.output + ": there are no strands to write: the scene grows no groom at this frame");
  }
  EXPECT_FALSE(std::filesystem::exists(options.output));
}

TEST_F(GrowExportTest, WritesThoseOfThePicturesLevelOfDetailWhereAsked) {
  EXPECT_LT(strands(grown(32, true)), 300u);
}

}  // namespace
}  // namespace pelage
