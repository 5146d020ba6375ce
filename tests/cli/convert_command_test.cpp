// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "base/temporary_folder.h"
#include "cli/commands.h"
#include "geom/io/strand_file.h"

namespace pelage {
namespace {

/// Three strands, one of which has no extent.
Strands three_strands() {
  StrandArrays a;
  a.first_point = {0};
  for (int s = 0; s < 3; ++s) {
    for (int k = 0; k < 4; ++k) {
      const float y = s == 1 ? 0.0f : 0.25f * static_cast<float>(k);
      a.points.insert(a.points.end(), {static_cast<float>(s), y, 0, 0.01f});
    }
    a.first_point.push_back(static_cast<uint32_t>(4 * (s + 1)));
    a.ids.push_back(static_cast<uint64_t>(s));
  }
  return Strands(std::move(a));
}

class ConvertCommandTest : public testing::Test {
 protected:
  ConvertCommandTest() {
    options_.command = Command::kConvert;
    options_.input = (folder_.path() / "a.hair").string();
    write_strands(options_.input, three_strands());
  }

  TemporaryFolder folder_;
  Options options_;
};

TEST_F(ConvertCommandTest, KeepsStrandsAndSaysWhatItDropped) {
  options_.output = (folder_.path() / "b.tfx").string();
  testing::internal::CaptureStdout();
  EXPECT_EQ(run_convert(options_), 0);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), options_.output + ": 2 strands, 1 dropped\n");
  const StrandFile file = read_strands(options_.output);
  EXPECT_EQ(file.format, "tfx");
  ASSERT_EQ(file.strands.strand_count(), 2u);
  EXPECT_EQ(file.strands.point(4).x, 2);
  EXPECT_EQ(file.strands.point(7).y, 0.75f);
}

TEST_F(ConvertCommandTest, RefusesFilesThatNeedMoreThanTheMemory) {
  for (const char* name : {"a.hair", "a.tfx", "a.usda", "a.abc"}) {
    options_.input = (folder_.path() / name).string();
    write_strands(options_.input, three_strands());
    const std::optional<Options> parsed = parse_options(
        {"convert", options_.input, (folder_.path() / "b.usda").string(), "--memory", "64"}, std::cout);
    ASSERT_TRUE(parsed);
    try {
      run_convert(*parsed);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kMemory);
      EXPECT_EQ(std::string(error.what()), options_.input +
                                               ": reading this file needs more than the 64 bytes that the "
                                               "memory limit leaves; raise --memory");
    }
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "b.usda"));
  }
}

/// Converts to a file of this name. Returns what standard error got.
class ConvertLossesTest : public ConvertCommandTest {
 protected:
  std::string errors(const std::string& input, const std::string& output) {
    options_.input = (folder_.path() / input).string();
    options_.output = (folder_.path() / output).string();
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    EXPECT_EQ(run_convert(options_), 0);
    out_ = testing::internal::GetCapturedStdout();
    return testing::internal::GetCapturedStderr();
  }
  std::string out_;
};

TEST_F(ConvertLossesTest, FixedPointsAndMissingWidthsStayAsTheyAre) {
  StrandArrays a = three_strands().arrays();
  a.attributes.push_back({"movable", AttributeClass::kPerPoint, 1, {0, 0, 1, 1, 0, 0, 0, 0, 0, 0.5f, 1, 0}});
  a.attributes.push_back({"opacity", AttributeClass::kPerPoint, 1, std::vector<float>(12, 0.25f)});
  write_strands(folder_.path() / "a.tfx", Strands(std::move(a)), false);
  EXPECT_EQ(errors("a.tfx", "b.tfx"), "");
  EXPECT_EQ(out_, options_.output + ": 2 strands without widths, 1 dropped\n");
  const StrandFile back = read_strands(options_.output, {{}, {}, true});
  EXPECT_GT(back.assumed_width, 0);
  EXPECT_EQ(back.strands.find_attribute("movable")->values, (std::vector<float>{0, 0, 1, 1, 0, 0.5f, 1, 0}));
  const std::string lost = errors("b.tfx", "c.hair");
  EXPECT_NE(lost.find("c.hair: .hair files cannot hold which points are fixed"), std::string::npos) << lost;
  EXPECT_EQ(std::count(lost.begin(), lost.end(), '\n'), 1) << lost;
  EXPECT_GT(read_strands(options_.output).assumed_width, 0);
  EXPECT_EQ(errors("c.hair", "d.tfx"), "");
  const Strands again = read_strands(options_.output).strands;
  EXPECT_EQ(again.find_attribute("opacity")->values, std::vector<float>(8, 0.25f));
  EXPECT_EQ(errors("d.tfx", "e.hair"), "") << "only roots are fixed, as everywhere";
  options_.default_width = 0.5f;
  EXPECT_EQ(errors("d.tfx", "f.hair"), "");
  EXPECT_EQ(read_strands(options_.output).strands.radius(3), 0.25f);
}

TEST_F(ConvertLossesTest, WarnOnceOfAllThatIsLost) {
  StrandArrays a = three_strands().arrays();
  a.points[3] = 0.02f;
  write_strands(folder_.path() / "a.hair", Strands(a));
  const std::string widths = errors("a.hair", "b.tfx");
  EXPECT_NE(widths.find("b.tfx: .tfx files cannot hold widths that vary along strands"), std::string::npos)
      << widths;
  a.root_uv.resize(3);
  a.attributes.push_back({"uv", AttributeClass::kPerPoint, 2, std::vector<float>(24, 0.5f)});
  write_strands(folder_.path() / "c.tfx", Strands(a));
  const std::string several = errors("c.tfx", "d.hair");
  EXPECT_NE(several.find("texture coordinates of roots, the attribute uv\n"), std::string::npos) << several;
}

TEST_F(ConvertLossesTest, UsdAndAlembicHoldEverythingBothWays) {
  StrandArrays a = three_strands().arrays();
  a.points[3] = 0.02f;
  a.attributes.push_back({"color", AttributeClass::kPerPoint, 3, std::vector<float>(36, 0.3f)});
  a.attributes.push_back({"transparency", AttributeClass::kPerPoint, 1, std::vector<float>(12, 0.7f)});
  write_strands(folder_.path() / "a.hair", Strands(a));
  errors("a.hair", "d.hair");
  for (const char* name : {"b.usda", "b.abc"}) {
    EXPECT_EQ(errors("a.hair", name), "");
    EXPECT_EQ(errors(name, "c.hair"), "");
    EXPECT_EQ(read_file(folder_.path() / "c.hair"), read_file(folder_.path() / "d.hair")) << name;
    options_.input = (folder_.path() / name).string();
    testing::internal::CaptureStdout();
    EXPECT_EQ(run_validate(options_), 0);
    const std::string said = testing::internal::GetCapturedStdout();
    EXPECT_NE(said.find("2 strands of "), std::string::npos) << said;
    EXPECT_NE(said.find("no problems"), std::string::npos) << said;
  }
}

TEST_F(ConvertLossesTest, FilesForUnrealHaveItsAxes) {
  options_.host = AlembicHost::kUnreal;
  EXPECT_EQ(errors("a.hair", "b.abc"), "");
  const Strands strands = read_strands(folder_.path() / "b.abc").strands;
  EXPECT_EQ(strands.basis(), CurveBasis::kLinear);
  ASSERT_EQ(strands.strand_count(), 2u);
  EXPECT_EQ(strands.point(7), V3f(2, 0, 0.75f));
  options_.output = (folder_.path() / "b.usda").string();
  EXPECT_THROW(run_convert(options_), Error);
}

TEST_F(ConvertCommandTest, ValidateNamesWhatHostsStumbleOver) {
  write_file(folder_.path() / "bad.usda", R"(#usda 1.0
def BasisCurves "hair" {
  uniform token type = "linear"
  int[] curveVertexCounts = [2, 1]
  point3f[] points = [(0, 0, 0), (1, 0, nan), (0, 1, 0)]
  float3[] extent = [(0, 0, 0), (0.5, 1, 0)]
}
)");
  options_.input = (folder_.path() / "bad.usda").string();
  testing::internal::CaptureStdout();
  EXPECT_EQ(run_validate(options_), 3);
  const std::string said = testing::internal::GetCapturedStdout();
  for (const char* part : {"1 strands have one point", "1 coordinates of points are not finite",
                           "it has no widths", "remark: ", "no texture coordinates", "no ids"})
    EXPECT_NE(said.find(part), std::string::npos) << part << "\n" << said;
}

TEST_F(ConvertCommandTest, RefusesWhatIsNoStrandFile) {
  options_.output = (folder_.path() / "b.obj").string();
  try {
    run_convert(options_);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kArguments);
    EXPECT_NE(std::string(error.what()).find("written as .hair, .tfx, .usda or .abc"), std::string::npos);
  }
}

}  // namespace
}  // namespace pelage
