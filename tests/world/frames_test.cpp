// SPDX-License-Identifier: Apache-2.0
#include "world/frames.h"

#include <gtest/gtest.h>

#include "base/hash.h"
#include "tests/support/parsed_value.h"

namespace pelage {
namespace {

using Frames = std::vector<int>;

Frames frames(const std::string& text) { return parse_frames(text).frames; }
std::string problem(const std::string& text) {
  try {
    parse_frames(text);
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kArguments);
    const std::string message = error.what();
    return message.substr(0, message.find("; frames are written"));
  }
}

TEST(Frames, RangesAndLists) {
  EXPECT_EQ(frames("7"), Frames{7});
  EXPECT_EQ(frames("1-4"), (Frames{1, 2, 3, 4}));
  EXPECT_EQ(frames("1-8x3"), (Frames{1, 4, 7}));
  EXPECT_EQ(frames("1,5,9-12"), (Frames{1, 5, 9, 10, 11, 12}));
  EXPECT_EQ(frames("-5--3"), (Frames{-5, -4, -3}));
  EXPECT_EQ(frames("-2-1"), (Frames{-2, -1, 0, 1}));
  EXPECT_EQ(frames("5,1-3,2"), (Frames{5, 1, 2, 3}));
  EXPECT_EQ(frames("2147483646-2147483647"), (Frames{2147483646, 2147483647}));
}

TEST(Frames, MistakesAreExplained) {
  EXPECT_EQ(problem(""), "'': expected a frame number");
  EXPECT_EQ(problem("a"), "'a': expected a frame number");
  EXPECT_EQ(problem("1-"), "'1-': expected the last frame after '-'");
  EXPECT_EQ(problem("4-1"), "'4-1': the range ends before it begins");
  EXPECT_EQ(problem("1-4x0"), "'1-4x0': expected a step of at least 1 after 'x'");
  EXPECT_EQ(problem("1-4x"), "'1-4x': expected a step of at least 1 after 'x'");
  EXPECT_EQ(problem("1-4y"), "'1-4y': unexpected 'y'");
  EXPECT_EQ(problem("1,"), "'1,': expected a frame number");
  EXPECT_EQ(problem("1.5"), "'1.5': unexpected '.5'");
  EXPECT_EQ(problem("99999999999"), "'99999999999': expected a frame number");
  EXPECT_EQ(problem("0-2147483647"), "'0-2147483647': more than 1000000 frames");
  EXPECT_EQ(problem("-2147483648-2147483647x2147483647"), "");
}

TEST(Frames, ArePrintedShortAndReadBack) {
  EXPECT_EQ(print_frames({{1}}), "1");
  EXPECT_EQ(print_frames({{1, 2}}), "1,2");
  EXPECT_EQ(print_frames({{1, 2, 3, 7, 9, 11}}), "1-3,7-11x2");
  for (uint64_t seed = 0; seed < 300; ++seed) {
    FrameList list{{}};
    int frame = -5;
    for (uint64_t i = 0; i < 1 + seed % 9; ++i)
      list.frames.push_back(frame += 1 + static_cast<int>(hash64(seed, i) % 3));
    EXPECT_EQ(frames(print_frames(list)), list.frames) << print_frames(list);
  }
}

TEST(Frames, StandInScenes) {
  FrameList out;
  Problems problems;
  EXPECT_TRUE(ValueReader<FrameList>::read(scalar("1-3"), {}, out, problems));
  EXPECT_EQ(out.frames, (Frames{1, 2, 3}));
  EXPECT_FALSE(ValueReader<FrameList>::read(list({}), {}, out, problems));
  EXPECT_FALSE(ValueReader<FrameList>::read(scalar("x"), {}, out, problems));
  EXPECT_EQ(problems.list()[0].message, "expected frames, such as 1 or 1-48, got a list of 0");
  EXPECT_EQ(problems.list()[1].position.line, 1);
}

TEST(FrameNames, TakeTheUsualPatterns) {
  EXPECT_EQ(frame_file_name("rat.%04d.exr", 7), "rat.0007.exr");
  EXPECT_EQ(frame_file_name("rat.%d.exr", 7), "rat.7.exr");
  EXPECT_EQ(frame_file_name("rat.####.exr", 7), "rat.0007.exr");
  EXPECT_EQ(frame_file_name("rat.#.exr", 12345), "rat.12345.exr");
  EXPECT_EQ(frame_file_name("rat.$F4.exr", 7), "rat.0007.exr");
  EXPECT_EQ(frame_file_name("rat.$F.exr", 7), "rat.7.exr");
  EXPECT_EQ(frame_file_name("rat.<F4>.exr", 7), "rat.0007.exr");
  EXPECT_EQ(frame_file_name("%03d/rat.%03d.exr", 7), "007/rat.007.exr");
  EXPECT_EQ(frame_file_name("rat.%04d.exr", -3), "rat.-0003.exr");
  EXPECT_EQ(frame_file_name("rat.%04d.exr", 123456), "rat.123456.exr");
}

TEST(FrameNames, LeaveOtherTextAlone) {
  for (const char* name : {"rat.exr", "100%.exr", "%s%n.exr", "%9999999d", "$Fx<F>"}) {
    const std::string made = frame_file_name(name, 5);
    if (std::string_view(name) == "$Fx<F>") {
      EXPECT_EQ(made, "5x5");
    } else {
      EXPECT_EQ(made, name);
      EXPECT_FALSE(has_frame_pattern(name));
    }
  }
  EXPECT_EQ(frame_file_name("50%%.%d", 5), "50%.5");
  EXPECT_FALSE(has_frame_pattern("50%%d"));
  EXPECT_TRUE(has_frame_pattern("a.%04d"));
  EXPECT_TRUE(has_frame_pattern("a.##"));
}

TEST(FrameNames, SeveralFramesNeedAPlace) {
  EXPECT_NO_THROW(check_output_pattern("a.exr", {{1}}));
  EXPECT_NO_THROW(check_output_pattern("a.%d.exr", {{1, 2}}));
  try {
    check_output_pattern("a.exr", {{1, 2}});
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_STREQ(
        error.what(),
        "2 frames cannot all be written to 'a.exr'; put the frame number into the name, as in rat.%04d.exr");
  }
}

}  // namespace
}  // namespace pelage
