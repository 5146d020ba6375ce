// SPDX-License-Identifier: Apache-2.0
#include "post/stereo_file.h"

#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "tests/post/exr_pictures.h"
#include "tests/post/picture.h"

namespace pelage {
namespace {

class StereoFile : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  PostReport run(const std::string& input, const std::string& output) {
    NoProgress progress;
    MemoryLedger ledger;
    const PostReport report = stereo_file(path(input), path(output), params_, {Workers(2), ledger, progress});
    charged_ = ledger.peak(MemoryTag::kFilm);
    return report;
  }
  std::string refusal(const std::string& input) {
    try {
      run(input, "refused.exr");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      return std::string(error.what()).substr(path(input).string().size());
    }
    ADD_FAILURE() << "accepted";
    return {};
  }
  /// A plane at depth 4, with a camera of focal length 100 pixels at x = 7.
  void write_with_camera(const std::string& name) {
    ExrImage image = still_image(80, 40);
    M44f camera;
    camera.setTranslation(V3f(-7, 0, 0));
    // x / z * 100 / 80 + 0.5, and the same for y with 40.
    const M44f project(1.25f, 0, 0, 0, 0, -2.5f, 0, 0, 0.5f, 0.5f, 1, 1, 0, 0, -0.1f, 0);
    image.attributes["worldToCamera"] = camera;
    image.attributes["worldToNDC"] = camera * project;
    image.attributes["pelage:metersPerUnit"] = 0.065f;
    write_exr(path(name), image);
  }

  TemporaryFolder folder_;
  StereoFileParams params_;
  int64_t charged_ = 0;
};

TEST_F(StereoFile, TakesTheCameraFromTheHeader) {
  write_with_camera("left.exr");
  params_.convergence = 8;
  params_.filter = StereoFilter::kBox;
  // 100 pixels * 1 unit * (1 / 8 - 1 / 4) = -12.5 pixels.
  EXPECT_NEAR(run("left.exr", "right.exr").longest, 12.5f, 1e-4);
  params_.eye_separation = 0.96f;
  EXPECT_NEAR(run("left.exr", "right.exr").longest, 12, 1e-4);
  const ExrImage left = read_exr(path("left.exr")), right = read_exr(path("right.exr"));
  for (int x = 0; x < 68; ++x) {
    ASSERT_EQ(right.find("R")->pixels[static_cast<size_t>(20 * 80 + x)],
              left.find("R")->pixels[static_cast<size_t>(20 * 80 + x + 12)]);
    ASSERT_EQ(right.find("id")->ids[static_cast<size_t>(20 * 80 + x)],
              left.find("id")->ids[static_cast<size_t>(20 * 80 + x + 12)]);
    ASSERT_EQ(right.find("invented.mask")->pixels[static_cast<size_t>(20 * 80 + x)], 0);
  }
  // Beyond the picture's side it is mirrored: all of it, or as much as is asked for.
  params_.file.longest_fill = 2;
  run("left.exr", "two.exr");
  const ExrImage two = read_exr(path("two.exr"));
  for (int x = 68; x < 80; ++x) {
    const auto at = static_cast<size_t>(20 * 80 + x);
    EXPECT_EQ(right.find("R")->pixels[at], left.find("R")->pixels[static_cast<size_t>(20 * 80 + 147 - x)]);
    EXPECT_EQ(right.find("invented.mask")->pixels[at], 1) << x;
    EXPECT_EQ(right.find("invented.hole")->pixels[at], 0) << x;
    EXPECT_EQ(two.find("invented.mask")->pixels[at], x < 70 ? 1 : 0) << x;
    EXPECT_EQ(two.find("invented.hole")->pixels[at], x < 70 ? 0 : 1) << x;
  }
}

TEST_F(StereoFile, TheOtherEyesCameraProjectsToWhereThePixelsWent) {
  write_with_camera("left.exr");
  params_.convergence = 8;
  params_.eye_separation = 0.96f;
  run("left.exr", "right.exr");
  const auto ndc = [&](const char* name, const V3f& world) {
    const M44f matrix = std::get<M44f>(read_exr(path(name)).attributes.at("worldToNDC"));
    V3f result;
    matrix.multVecMatrix(world, result);
    return V2f(result.x * 80, result.y * 40);
  };
  for (const V3f& point : {V3f(7, 0, 4), V3f(8, 0.3f, 4), V3f(6.5f, -0.2f, 4)}) {
    const V2f left = ndc("left.exr", point), right = ndc("right.exr", point);
    EXPECT_NEAR(right.x - left.x, -12, 1e-3);
    EXPECT_NEAR(right.y, left.y, 1e-4);
  }
  const V2f converged = ndc("right.exr", V3f(7, 0, 8)) - ndc("left.exr", V3f(7, 0, 8));
  EXPECT_NEAR(converged.x, 0, 1e-3);
}

TEST_F(StereoFile, LeavesNoHolesAroundThinThings) {
  // Strands of one pixel, half covered, in front of each other and of a sky.
  ExrImage image = still_image(160, 12);
  for (size_t i = 0; i < 160 * 12; ++i) {
    const size_t x = i % 160;
    const bool strand = x % 7 == 0;
    pixels_of(image, "A")[i] = strand ? 0.5f : 0.0f;
    pixels_of(image, "R")[i] = strand ? 0.5f : 0.0f;
    pixels_of(image, "Z")[i] = strand ? 2 + 0.5f * static_cast<float>(x % 3) : 1000;
  }
  write_exr(path("in.exr"), image);
  params_.focal_pixels = 100;
  params_.eye_separation = 0.5f;
  params_.convergence = 3;
  params_.filter = StereoFilter::kBox;
  run("in.exr", "out.exr");
  ExrImage out = read_exr(path("out.exr"));
  double before = 0, after = 0;
  for (size_t i = 0; i < 160 * 12; ++i) {
    ASSERT_EQ(pixels_of(out, "invented.hole")[i], 0);
    before += pixels_of(image, "A")[i];
    after += pixels_of(out, "A")[i];
  }
  // Strands neither become wider nor vanish, except for those that become occluded by others.
  EXPECT_NEAR(after / before, 1, 0.15);
}

TEST_F(StereoFile, WarnsOfAParallaxWiderThanThePicture) {
  write_with_camera("left.exr");
  params_.convergence = 8;
  EXPECT_TRUE(run("left.exr", "right.exr").warnings.empty());
  params_.eye_separation = 7;
  const PostReport report = run("left.exr", "right.exr");
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_EQ(report.warnings[0],
            "the parallax reaches 88 pixels, more than the picture's width of 80; check --eye-separation and "
            "--convergence");
}

TEST_F(StereoFile, SamePixelsForAnyBudget) {
  ExrImage image = still_image(300, 200);
  for (size_t i = 0; i < image.find("Z")->pixels.size(); ++i)
    pixels_of(image, "Z")[i] = 2 + 3 * unit_float(hash64(i / 97, 1));
  write_exr(path("in.exr"), image);
  params_.focal_pixels = 100;
  params_.eye_separation = 0.4f;
  EXPECT_EQ(run("in.exr", "whole.exr").bands, 1);
  params_.strip_rows = 2;
  params_.file.memory = charged_ * 6 / 10;
  EXPECT_GT(run("in.exr", "bands.exr").bands, 1);
  const ExrImage a = read_exr(path("whole.exr")), b = read_exr(path("bands.exr"));
  for (size_t c = 0; c < a.channels.size(); ++c) {
    EXPECT_EQ(bits(a.channels[c].pixels), bits(b.channels[c].pixels)) << a.channels[c].name;
  }
}

TEST_F(StereoFile, MakesOneViewOfAnother) {
  write_exr(path("like.exr"), still_image(4, 4));
  const PixelBox box{0, 0, 40, 20};
  const std::vector<float> ones(800, 1), depth(800, 5), shift(800, -3), none(800, 0);
  write_parts(path("in.exr"), path("like.exr"), box,
              {{"rgb_right", box, {{"R", ChannelType::kHalf}}, {ones}, "right"},
               {"rgb_left", box, {{"R", ChannelType::kHalf}}, {ones}, "left"},
               {"z_left", box, {{"Z", ChannelType::kFloat}}, {depth}, "left"},
               {"disparityR",
                box,
                {{"disparityR.x", ChannelType::kHalf}, {"disparityR.y", ChannelType::kHalf}},
                {shift, none},
                ""}});
  params_.parallax = "disparityR";
  EXPECT_EQ(run("in.exr", "out.exr").longest, 3);
  const ExrReader out(path("out.exr"));
  ASSERT_EQ(out.parts().size(), 2u);
  EXPECT_EQ(out.parts()[0].name, "rgb_right");
  EXPECT_EQ(out.parts()[0].view, "right");
  EXPECT_EQ(out.parts()[1].name, "z_right");
  EXPECT_EQ(out.parts()[0].channels.size(), 3u);
  params_.view = "middle";
  EXPECT_EQ(refusal("in.exr").find(": has no view 'middle'"), 0u);
}

TEST_F(StereoFile, RefusesInOneLineWhatItCannotUse) {
  write_exr(path("in.exr"), still_image(16, 16));
  EXPECT_EQ(
      refusal("in.exr"),
      ": contains no camera (worldToCamera, worldToNDC); give --fov, --focal-pixels or --parallax-layer");
  params_.fov_deg = 40;
  EXPECT_EQ(refusal("in.exr"), ": does not give the length of a unit; give --eye-separation");
  params_.eye_separation = 1;
  run("in.exr", "out.exr");
  ExrImage flat = still_image(16, 16);
  std::erase_if(flat.channels, [](const ExrChannel& c) { return c.name == "Z"; });
  write_exr(path("flat.exr"), flat);
  EXPECT_EQ(refusal("flat.exr").find(": has no depth; name a layer with --depth-layer"), 0u);
  params_.parallax = "nothing";
  EXPECT_EQ(refusal("in.exr").find(": has no layer 'nothing'"), 0u);
}

}  // namespace
}  // namespace pelage
