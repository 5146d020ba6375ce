// SPDX-License-Identifier: Apache-2.0
#include <csignal>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "cli/commands.h"
#include "cli/signals.h"
#include "image/exr.h"
#include "tests/world/small_scene.h"

namespace pelage {
namespace {

class RenderCommandTest : public testing::Test {
 protected:
  Options options(const std::string& output) const {
    Options result;
    result.command = Command::kRender;
    result.input = scene_.path("scene.yaml");
    result.output = scene_.path(output);
    result.progress = ProgressStyle::kQuiet;
    return result;
  }
  /// Renders one sample with these settings, and returns what was written to the standard error stream.
  std::string shown_with(std::vector<Override> overrides) const {
    Options o = options("x.exr");
    o.progress = ProgressStyle::kPlain;
    o.overrides = std::move(overrides);
    o.overrides.push_back({"render.samples", "1"});
    testing::internal::CaptureStderr();
    EXPECT_EQ(run_render(o), 0);
    return testing::internal::GetCapturedStderr();
  }
  SmallScene scene_;
};

TEST_F(RenderCommandTest, WritesLayersHeaderAndStatistics) {
  Options o = options("out/frame.exr");
  o.stats = scene_.path("stats.json");
  ASSERT_EQ(run_render(o), 0);

  const ExrImage image = read_exr(o.output);
  EXPECT_EQ(image.width, 24);
  EXPECT_EQ(image.height, 16);
  for (const char* name :
       {"R", "G", "B", "A", "Z", "N.X", "tangent.Z", "forward.u", "forward.v", "id", "root.u",
        "key.diffuse.R", "key.primary.G", "key.secondary.B", "sky.diffuse.R", "sky.emission.B"}) {
    EXPECT_NE(image.find(name), nullptr) << name;
  }
  for (const char* name : {"worldToCamera", "worldToNDC", "screenWindowWidth", "pelage:seed",
                           "pelage:samples", "pelage:version"}) {
    EXPECT_TRUE(image.attributes.contains(name)) << name;
  }
  EXPECT_EQ(std::get<int>(image.attributes.at("pelage:samples")), 4);
  EXPECT_EQ(std::get<V2f>(image.attributes.at("pelage:shutter")), V2f(-0.25f, 0.25f));
  EXPECT_FLOAT_EQ(std::get<float>(image.attributes.at("expTime")), 0.5f / 24);

  const auto stats = nlohmann::json::parse(read_file(*o.stats));
  EXPECT_EQ(stats["strands_described"], 400);
  EXPECT_EQ(stats["strands_generated"], 400);
  EXPECT_EQ(stats["characters_in_frame"], 1);
  EXPECT_EQ(stats["rays"]["camera"], 24 * 16 * 4);
  double cpu_s = 0;
  for (const auto& [part, seconds] : stats["cpu_s_by"].items()) cpu_s += seconds.get<double>();
  EXPECT_DOUBLE_EQ(cpu_s, stats["cpu_s"].get<double>());
  EXPECT_GT(stats["memory_bytes"]["chunks"], 0);
  EXPECT_EQ(stats["samples_rejected"], 0);
}

TEST_F(RenderCommandTest, SamePixelsForAnyNumberOfThreads) {
  Options one = options("one.exr"), three = options("three.exr");
  one.threads = 1;
  three.threads = 3;
  ASSERT_EQ(run_render(one), 0);
  ASSERT_EQ(run_render(three), 0);
  const ExrImage a = read_exr(one.output), b = read_exr(three.output);
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (size_t i = 0; i < a.channels.size(); ++i) {
    EXPECT_EQ(a.channels[i].pixels, b.channels[i].pixels) << a.channels[i].name;
    EXPECT_EQ(a.channels[i].ids, b.channels[i].ids) << a.channels[i].name;
  }
}

TEST_F(RenderCommandTest, FramesGoToFilesOfTheirOwn) {
  Options o = options("walk.%04d.exr");
  o.overrides = {{"frames", "1-2"}, {"render.samples", "1"}};
  ASSERT_EQ(run_render(o), 0);
  EXPECT_NE(read_exr(scene_.path("walk.0001.exr")).find("R")->pixels,
            read_exr(scene_.path("walk.0002.exr")).find("R")->pixels);

  o.output = scene_.path("one.exr");
  EXPECT_THROW(run_render(o), Error);  // two frames, one name
}

TEST_F(RenderCommandTest, EndingsAreReadInAnyCase) {
  Options o = options("x.EXR");
  o.overrides = {{"render.samples", "1"}};
  EXPECT_EQ(run_render(o), 0);
  EXPECT_EQ(read_exr(o.output).width, 24);
}

TEST_F(RenderCommandTest, ScenesWithoutLightAreNamed) {
  const auto warnings = [&](std::vector<Override> overrides) {
    const std::string shown = shown_with(std::move(overrides));
    return shown.find("pictures will be black") != std::string::npos ? 1 : 0;
  };
  EXPECT_EQ(warnings({}), 0);
  EXPECT_EQ(warnings({{"lights", "{}"}}), 1);
  EXPECT_EQ(warnings({{"lights.key.intensity", "0"}, {"lights.sky.radiance", "0"}}), 1);
  EXPECT_EQ(warnings({{"lights.key.intensity", "0"}, {"lights.sky.intensity", "{keys: {1: 0, 9: 1}}"}}), 0);
}

TEST_F(RenderCommandTest, BlackAndEmptyPicturesSayWhy) {
  const auto said = [&](std::vector<Override> overrides) {
    const std::string shown = shown_with(std::move(overrides));
    return shown.substr(std::min(shown.find("the picture is "), shown.size()), 20);
  };
  EXPECT_EQ(said({}), "");
  EXPECT_EQ(said({{"lights.sky", "null"}, {"camera.look_at", "[3, 2, 9]"}}), "the picture is empty");
  EXPECT_EQ(said({{"camera.look_at", "[3, 2, 9]"}}), "") << "sky";
  EXPECT_EQ(said({{"lights.sky", "null"},
                  {"lights.key.position", "[1000, -1000, -1000]"},
                  {"characters.walker", "null"},
                  {"materials.hide.color", "0"}}),
            "the picture is black");
  EXPECT_EQ(said({{"lights", "{}"}}), "") << "the missing light is named before";
}

TEST_F(RenderCommandTest, OutputThatCannotBeWrittenIsFoundBeforeRendering) {
  Options o = options("x.exr");
  o.output = "/proc/none/x.exr";
  o.overrides = {{"render.samples", "1000000"}};  // would take for ever
  try {
    run_render(o);
    FAIL() << "wrote into /proc";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kFailed);
  }
}

TEST_F(RenderCommandTest, BudgetThatIsTooSmallSaysForWhat) {
  const auto refused = [&](std::vector<Override> overrides) -> std::string {
    Options o = options("x.exr");
    o.overrides = std::move(overrides);
    try {
      run_render(o);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kMemory);
      EXPECT_FALSE(std::filesystem::exists(o.output));
      return error.what();
    }
    return "rendered";
  };
  EXPECT_NE(refused({{"render.memory", "4G"}, {"image", "{width: 65536, height: 65536}"}})
                .find("the frame buffer alone"),
            std::string::npos);
  EXPECT_NE(refused({{"render.memory", "2M"}, {"grooms.coat.strands", "100000"}})
                .find("placing 100000 strands of groom 'coat' needs 12."),
            std::string::npos);
  // The same that would do, whether strands are measured first or not.
  const auto too_large = [&](const std::string& bounds) {
    return refused({{"render.memory", "30M"},
                    {"render.bounds", bounds},
                    {"grooms.coat.strands", "100000"},
                    {"grooms.coat.leaf_strands", "100000"}});
  };
  const std::string measured = too_large("exact"), stated = too_large("conservative");
  EXPECT_NE(measured.find("growing the largest chunk of walker.coat needs"), std::string::npos);
  EXPECT_NE(stated.find("the largest chunk (of walker.coat) needs"), std::string::npos);
  const auto first_number = [](const std::string& text) {
    return std::stod(text.substr(text.find("needs ") + 6));
  };
  EXPECT_NEAR(first_number(measured), first_number(stated), 0.02 * first_number(stated));
}

TEST_F(RenderCommandTest, AttributesThatStrandsLackAreReportedWhereTheyAreNamed) {
  scene_.write("colour.yaml", "include: scene.yaml\nmaterials:\n  fur: {color: {attribute: colour}}\n");
  Options o = options("x.exr");
  o.input = scene_.path("colour.yaml");
  try {
    run_render(o);
    FAIL() << "rendered";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    const Problem& problem = error.problems().at(0);
    EXPECT_EQ(to_string(problem.position), o.input + ":3:28");
    EXPECT_NE(problem.message.find("no attribute 'colour'"), std::string::npos) << problem.message;
  }
}

TEST_F(RenderCommandTest, AStrandFileOfAnUnknownKindIsReportedWhereItIsNamed) {
  scene_.write("guides.xgn", "x");
  scene_.write("guides.yaml",
               "include: scene.yaml\ngrooms:\n  coat: {operators: [{guides: {file: guides.xgn}}]}\n");
  scene_.write("file.yaml",
               "include: scene.yaml\ngrooms:\n  more: {strands_file: guides.xgn}\ncharacters:\n"
               "  post: {parts: [{skin: still, material: hide, grooms: {more: fur}}]}\n");
  for (const auto& [scene, place] : {std::pair("guides.yaml", ":3:38"), std::pair("file.yaml", ":3:24")}) {
    Options o = options("x.exr");
    o.input = scene_.path(scene);
    try {
      run_render(o);
      ADD_FAILURE() << "rendered";
    } catch (const Error& error) {
      const Problem& problem = error.problems().at(0);
      EXPECT_EQ(to_string(problem.position), o.input + place);
      EXPECT_NE(problem.message.find(".hair, .tfx, .usda or .abc"), std::string::npos) << problem.message;
    }
  }
}

TEST_F(RenderCommandTest, PicturesAreExrPngOrJpeg) {
  try {
    run_render(options("x.tif"));
    FAIL() << "wrote a picture named .tif";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kArguments);
  }
}

}  // namespace
}  // namespace pelage
