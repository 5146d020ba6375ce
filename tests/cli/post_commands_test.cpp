// SPDX-License-Identifier: Apache-2.0
#include <sstream>

#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "cli/commands.h"
#include "tests/post/exr_pictures.h"

namespace pelage {
namespace {

class PostCommands : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  static Options options(std::vector<std::string> arguments) {
    arguments.push_back("--quiet");
    std::ostringstream out;
    return parse_options(arguments, out).value();
  }
  static std::string refusal(const std::vector<std::string>& arguments) {
    try {
      const Options parsed = options(arguments);
      parsed.command == Command::kStereo ? run_stereo(parsed) : run_motion_blur(parsed);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kArguments) << error.what();
      return error.what();
    }
    return "accepted";
  }
  TemporaryFolder folder_;
};

TEST_F(PostCommands, FlagsReachTheTools) {
  const Options blur = options({"motionblur",
                                "a.exr",
                                "-o",
                                "b.exr",
                                "--shutter",
                                "0.25",
                                "--steps",
                                "5",
                                "--scale",
                                "6",
                                "--motion-layer",
                                "mv",
                                "--motion-units",
                                "ndc",
                                "--motion-y",
                                "up",
                                "--motion-scale",
                                "2",
                                "--depth-layer",
                                "far",
                                "--data-layer",
                                "x",
                                "--data-layer",
                                "y",
                                "--memory",
                                "1G",
                                "--shutter-centre",
                                "-0.5",
                                "--fill",
                                "9"});
  EXPECT_EQ(blur.input, "a.exr");
  EXPECT_EQ(blur.output, "b.exr");
  const BlurFileParams& b = blur.motion_blur;
  EXPECT_EQ(b.shutter.length, 0.25f);
  EXPECT_EQ(b.shutter.centre, -0.5f);
  EXPECT_EQ(b.shutter.steps, 5);
  EXPECT_EQ(b.file.longest_fill, 9);
  EXPECT_EQ(b.file.scale, 6);
  EXPECT_EQ(b.file.layers.motion, "mv");
  EXPECT_EQ(b.file.layers.depth, "far");
  EXPECT_EQ(b.file.layers.data, (std::vector<std::string>{"x", "y"}));
  EXPECT_TRUE(b.file.vectors.is_ndc && b.file.vectors.is_y_up);
  EXPECT_EQ(b.file.vectors.scale, 2);
  EXPECT_EQ(b.file.memory, int64_t{1} << 30);

  const StereoFileParams s = options({"stereo",
                                      "a.exr",
                                      "-o",
                                      "b.exr",
                                      "--eye-separation",
                                      "6",
                                      "--convergence",
                                      "55",
                                      "--fov",
                                      "30",
                                      "--filter",
                                      "box",
                                      "--eye",
                                      "left",
                                      "--fill",
                                      "7",
                                      "--view",
                                      "main",
                                      "--parallax-layer",
                                      "d"})
                                 .stereo;
  EXPECT_EQ(s.eye_separation, 6.0f);
  EXPECT_EQ(s.convergence, 55);
  EXPECT_EQ(s.fov_deg, 30.0f);
  EXPECT_EQ(s.filter, StereoFilter::kBox);
  EXPECT_TRUE(s.to_left);
  EXPECT_EQ(s.file.longest_fill, 7);
  EXPECT_EQ(s.view, "main");
  EXPECT_EQ(s.parallax, "d");
  EXPECT_EQ(s.file.scale, 6);
}

TEST_F(PostCommands, FramesGoFromFileToFile) {
  write_exr(path("in.0003.exr"), still_image(8, 8));
  write_exr(path("in.0005.exr"), still_image(9, 8));
  ASSERT_EQ(run_motion_blur(options(
                {"motionblur", path("in.%04d.exr"), "-o", path("new/out.####.exr"), "--frames", "3,5"})),
            0);
  EXPECT_EQ(read_exr(path("new/out.0003.exr")).width, 8);
  EXPECT_EQ(read_exr(path("new/out.0005.exr")).width, 9);
}

// Vectors that a renderer left at zero, although something comes nearer.
TEST_F(PostCommands, MissingVectorsAreNamed) {
  const auto warned = [&](float depth, float motion) {
    ExrImage second = still_image(8, 8);
    pixels_of(second, "Z").assign(64, depth);
    pixels_of(second, "forward.u")[9] = motion;
    write_exr(path("in.0001.exr"), still_image(8, 8));
    write_exr(path("in.0002.exr"), second);
    testing::internal::CaptureStderr();
    EXPECT_EQ(run_motion_blur(options(
                  {"motionblur", path("in.%04d.exr"), "-o", path("out.%04d.exr"), "--frames", "1-2"})),
              0);
    return testing::internal::GetCapturedStderr().find("all motion vectors of all frames are zero") !=
           std::string::npos;
  };
  EXPECT_TRUE(warned(3, 0));
  EXPECT_FALSE(warned(3, 1));
  EXPECT_FALSE(warned(4, 0));  // nothing moves
}

TEST_F(PostCommands, MistakesAreNamed) {
  EXPECT_EQ(refusal({"motionblur", "a.exr", "-o", "b.png"}), "-o b.png: pictures are written as .exr");
  EXPECT_EQ(refusal({"motionblur", "a.%04d.exr", "-o", "b.exr"}),
            "a.%04d.exr: give the frames with --frames");
  EXPECT_EQ(refusal({"motionblur", "a.exr", "-o", "b.%d.exr", "--frames", "1-3"}),
            "a.exr: the file name of several frames needs a frame number, as in %04d");
  EXPECT_EQ(refusal({"motionblur", "a.exr", "-o", "b.exr", "--motion-y", "upp"}),
            "--motion-y 'upp' is not known; did you mean 'up'?");
  EXPECT_EQ(refusal({"stereo", "a.exr", "-o", "b.exr", "--convergence", "-3"}),
            "--convergence: expected a distance above 0 or 'infinite', got '-3'");
  EXPECT_EQ(refusal({"stereo", "a.exr", "-o", "b.exr", "--parallax-units", "meters"}),
            "--parallax-units 'meters' is not known; expected one of pixels, ndc");
  for (const char* flag : {"--shutter", "--shutter-centre", "--motion-scale"}) {
    const std::string problem = refusal({"motionblur", "a.exr", "-o", "b.exr", flag, "nan"});
    EXPECT_EQ(problem.find(flag + std::string(": expected a ")), 0u) << problem;
  }
  for (const char* flag : {"--eye-separation", "--focal-pixels", "--fov", "--parallax-scale"}) {
    const std::string problem = refusal({"stereo", "a.exr", "-o", "b.exr", flag, "nan"});
    EXPECT_EQ(problem.find(flag + std::string(": expected a ")), 0u) << problem;
  }
  EXPECT_NE(refusal({"motionblur", "a.exr", "-o", "b.exr", "--scale", "9"}), "accepted");
  EXPECT_NE(refusal({"motionblur", "a.exr"}), "accepted");
}

}  // namespace
}  // namespace pelage
