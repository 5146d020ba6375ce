// SPDX-License-Identifier: Apache-2.0
// Level of detail in pictures: what it must not depend on, and what it must leave alone.
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cli/commands.h"
#include "cli/measure/lod_pictures.h"
#include "cli/measure/picture_difference.h"
#include "image/exr.h"
#include "tests/support/temporary_folder.h"

namespace pelage {
namespace {

class LodPictures : public testing::Test {
 protected:
  using Settings = std::vector<Override>;

  std::filesystem::path render(const std::string& name, const Settings& settings) {
    Options options;
    options.command = Command::kRender;
    options.input = (std::filesystem::path(PELAGE_SOURCE_DIR) / "examples" / "colony_small.yaml").string();
    options.progress = ProgressStyle::kQuiet;
    options.output = (folder_.path() / (name + ".exr")).string();
    options.overrides = {{"image.width", "160"},          {"image.height", "90"},
                         {"image.lod_layer", "true"},     {"render.samples", "2"},
                         {"grooms.under.strands", "900"}, {"grooms.guard.strands", "400"}};
    for (const char* groom : {"under", "guard", "whiskers"}) {
      options.overrides.push_back(
          {std::string("grooms.") + groom + ".cache.directory", (folder_.path() / "cache").string()});
    }
    options.overrides.insert(options.overrides.end(), settings.begin(), settings.end());
    EXPECT_EQ(run_render(options), 0);
    return options.output;
  }
  static void expect_equal(const std::filesystem::path& a, const std::filesystem::path& b) {
    const auto difference = compare_picture_files(a, b);
    ASSERT_TRUE(difference);
    EXPECT_EQ(difference->differing, 0) << a << " " << b;
  }
  static float most_left_out(const std::filesystem::path& path) {
    const ExrImage image = read_exr(path);
    const std::vector<float>& layer = image.find("lod")->pixels;
    return *std::max_element(layer.begin(), layer.end());
  }

  TemporaryFolder folder_;
};

const Override kOn{"render.lod.enabled", "true"}, kOff{"render.lod.enabled", "false"};

TEST_F(LodPictures, NothingButTheViewDecides) {
  const auto first = render("first", {kOn});
  EXPECT_GT(most_left_out(first), 0.3f);
  expect_equal(first, render("warm", {kOn}));
  expect_equal(first, render("leaves", {kOn, {"grooms.under.leaf_strands", "41"}}));
  expect_equal(first, render("boxes", {kOn, {"render.bounds", "conservative"}}));
  expect_equal(first, render("eager", {kOn, {"render.bounds", "none"}}));
  expect_equal(first, render("linear", {kOn, {"render.bounds", "linear"}}));
}

TEST_F(LodPictures, WhereEverythingIsKeptItIsAsIfThereWereNone) {
  const Settings kept{kOn, {"render.lod.quality", "100"}, {"render.lod.least_share", "1"}};
  const auto off = render("off", {kOff});
  EXPECT_EQ(most_left_out(off), 0);
  expect_equal(off, render("on", kept));
}

TEST_F(LodPictures, ACameraOfItsOwnDecidesAlone) {
  const Override still{"render.lod.camera",
                       "{position: [0, 40, 0], look_at: [0, 0, -101], fov: 25, shutter: [-0.25, 0.25]}"};
  const auto main = render("main", {kOn});
  expect_equal(main, render("same", {kOn, still}));
  const auto change = change_between(main, render("far", {kOn,
                                                          {"render.lod.camera",
                                                           "{position: [0, 400, 0], "
                                                           "look_at: [0, 0, -101]}"}}));
  EXPECT_GT(change.largest, 0.01);
}

TEST_F(LodPictures, FalseColoursShowWhatWasLeftOut) {
  const auto picture = detail_picture(render("colours", {kOn}));
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->pixels.size(), size_t(160) * 90 * 3);
  EXPECT_FALSE(picture_sheet({folder_.path() / "missing.exr"}, 1, 80, ""));
  const auto sheet =
      picture_sheet({folder_.path() / "colours.exr", folder_.path() / "colours.exr"}, 2, 80, "");
  ASSERT_TRUE(sheet);
  EXPECT_EQ(sheet->width, 160);
  EXPECT_EQ(sheet->height, 45);
}

}  // namespace
}  // namespace pelage
