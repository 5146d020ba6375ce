// SPDX-License-Identifier: Apache-2.0
// Level of detail in pictures: what it must not depend on, and what it must leave alone.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "cli/commands.h"
#include "image/exr.h"
#include "lab/measure/lod_pictures.h"
#include "lab/pictures/picture_difference.h"
#include "lab/runs/run_statistics.h"

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
    options.stats = (folder_.path() / (name + ".json")).string();
    options.overrides = {{"image.width", "160"},          {"image.height", "90"},
                         {"image.lod_layer", "true"},     {"render.samples", "2"},
                         {"grooms.under.strands", "900"}, {"grooms.guard.strands", "400"},
                         {"crowds.front.count", "2"},     {"crowds.colony.count", "4"}};
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
  static float max_left_out(const std::filesystem::path& path) {
    const ExrImage image = read_exr(path);
    const std::vector<float>& layer = image.find("lod")->pixels;
    return *std::max_element(layer.begin(), layer.end());
  }

  TemporaryFolder folder_;
};

const Override kOn{"render.lod.enabled", "true"}, kOff{"render.lod.enabled", "false"};

TEST_F(LodPictures, NothingButTheViewDecides) {
  const auto first = render("first", {kOn});
  EXPECT_GT(max_left_out(first), 0.3f);
  expect_equal(first, render("warm", {kOn}));
  expect_equal(first, render("leaves", {kOn, {"grooms.under.leaf_strands", "41"}}));
  expect_equal(first, render("boxes", {kOn, {"render.bounds", "conservative"}}));
  expect_equal(first, render("eager", {kOn, {"render.bounds", "none"}}));
  expect_equal(first, render("linear", {kOn, {"render.bounds", "linear"}}));
}

TEST_F(LodPictures, WhereEverythingIsKeptItIsAsIfThereWereNone) {
  const Settings kept{kOn, {"render.lod.quality", "100"}, {"render.lod.min_fraction", "1"}};
  const auto off = render("off", {kOff});
  EXPECT_EQ(max_left_out(off), 0);
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

// Two cameras beside each other grow the same hairs, all of them: `bounds: none` grows what no ray meets too.
TEST_F(LodPictures, BothEyesSeeTheSameHairs) {
  const Override eager{"render.bounds", "none"};
  const Override left{"camera.position", "[-30, 40, 0]"}, right{"camera.position", "[30, 40, 0]"};
  const Override own{"render.lod.camera",
                     "{position: [0, 40, 0], look_at: [0, 0, -101], fov: 25, shutter: [-0.25, 0.25]}"};
  const auto hairs = [&](const std::string& name, const Settings& settings) {
    render(name, settings);
    return RunStatistics::read(folder_.path() / (name + ".json"))->number("strands_generated");
  };
  EXPECT_EQ(hairs("left", {kOn, eager, own, left}), hairs("right", {kOn, eager, own, right}));
  EXPECT_NE(hairs("left", {kOn, eager, left}), hairs("right", {kOn, eager, right}));
}

// What is left out changes with the way of the camera that decides, where shares fall: a sixteenth of the way
// changes less than half as much (root of the mean square: of as many samples as the camera moves another
// strand is nearest). That no strand pops is a test of Simplification.
TEST_F(LodPictures, SmallStepsChangeLittle) {
  const auto seen_from = [&](double distance) {
    const std::string name = "at" + std::to_string(distance);
    render(name, {kOn,
                  {"render.samples", "8"},
                  {"render.bounces", "0"},  // the noise of indirect light would hide small changes
                  {"render.lod.camera", "{position: [0, " + std::to_string(40 * distance) +
                                            ", 0], look_at: [0, 0, -101], fov: 25}"}});
    return name;
  };
  const auto picture = [&](const std::string& name) { return folder_.path() / (name + ".exr"); };
  const auto hairs = [&](const std::string& name) {
    return RunStatistics::read(folder_.path() / (name + ".json"))->number("strands_generated");
  };
  const std::string from = seen_from(0.2), near = seen_from(0.202), far = seen_from(0.232);
  EXPECT_GT(hairs(from), hairs(far));
  const double step = change_between(picture(from), picture(near)).rms;
  EXPECT_GT(step, 0);
  EXPECT_LT(step, 0.5 * change_between(picture(from), picture(far)).rms);
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

/// A ball of combed fur on a skin, seen from one place; the LOD camera is `distance` away.
class LodBall : public testing::Test {
 protected:
  struct Seen {
    double coverage = 0, luminance = 0;
  };
  Seen seen(double distance, const std::vector<Override>& settings = {}) {
    std::ofstream(folder_.path() / "ball.yaml") << R"(pelage: 1
camera: {position: [0, 0, 12], look_at: [0, 0, 0], fov: 24}
image: {width: 100, height: 100, light_layers: false}
skins: {ball: {mesh: )" << PELAGE_SOURCE_DIR << R"(/examples/pebble.obj}}
grooms:
  coat:
    skin: ball
    strands: 60000
    operators:
      - length: {value: 0.5, variation: 0.3}
      - comb: {direction: [0, -1, 0.3], lift: 0.4}
      - frizz: {amplitude: 0.02, frequency: 3}
      - width: {root: 0.004, tip: 0.001}
materials: {hide: {model: lambert}, fur: {model: cone-shell, diffuse: 0.6}}
characters: {one: {parts: [{skin: ball, material: hide, grooms: {coat: fur}}]}}
lights:
  sky: {type: environment, radiance: 0.1}
  key: {type: rectangle, position: [60, 60, 60], look_at: [0, 0, 0], size: [8, 8], radiance: 200}
render: {samples: 16, bounces: 0}
)";
    Options options;
    options.command = Command::kRender;
    options.input = (folder_.path() / "ball.yaml").string();
    options.output = (folder_.path() / "ball.exr").string();
    options.stats = (folder_.path() / "ball.json").string();
    options.progress = ProgressStyle::kQuiet;
    options.overrides = {{"render.lod.enabled", distance > 0 ? "true" : "false"},
                         {"render.lod.camera", "{position: [0, 0, " + std::to_string(distance) +
                                                   "], look_at: [0, 0, -1], fov: 24}"}};
    options.overrides.insert(options.overrides.end(), settings.begin(), settings.end());
    EXPECT_EQ(run_render(options), 0);
    strands_ = RunStatistics::read(*options.stats)->number("strands_generated");
    const ExrImage image = read_exr(options.output);
    const auto mean = [&](const char* channel) {
      const std::vector<float>& pixels = image.find(channel)->pixels;
      return std::accumulate(pixels.begin(), pixels.end(), 0.0) / static_cast<double>(pixels.size());
    };
    return {mean("A"), (0.2126 * mean("R") + 0.7152 * mean("G") + 0.0722 * mean("B")) / mean("A")};
  }

  TemporaryFolder folder_;
  double strands_ = 0;
};

// Silhouettes of hair are where coverage is neither full nor none.
TEST_F(LodBall, CoversAsMuchAsBefore) {
  const double full = seen(0).coverage;
  EXPECT_EQ(strands_, 60000);
  EXPECT_NEAR(seen(6).coverage, full, 0.01 * full);
  EXPECT_LT(strands_, 0.15 * 60000);
  EXPECT_GT(strands_, 0.08 * 60000);
  EXPECT_NEAR(seen(25).coverage, full, 0.02 * full);
  EXPECT_LT(strands_, 0.04 * 60000);
}

TEST_F(LodBall, IsAsBrightAsBefore) {
  const std::vector<Override> clean{{"render.samples", "24"}, {"render.bounces", "1"}};
  const double full = seen(0, clean).luminance;
  EXPECT_NEAR(seen(6, clean).luminance, full, 0.01 * full);
  EXPECT_NEAR(seen(25, clean).luminance, full, 0.02 * full);
}

// Seen from beside the light, nothing is in shadow but what light that left skin or wide strands in the gap
// that they were seen through would not find: 17 % there, if it left them so.
TEST_F(LodBall, HasNoHotSpotBesideTheLight) {
  const std::vector<Override> beside{{"render.bounces", "1"}, {"lights.key.position", "[3.5, 0, 100]"}};
  const double full = seen(0, beside).luminance;
  EXPECT_NEAR(seen(25, beside).luminance, full, 0.04 * full);
}

}  // namespace
}  // namespace pelage
