// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/file.h"
#include "base/temporary_folder.h"
#include "geom/usd/usd_curves_file.h"
#include "geom/usd/usd_files.h"
#include "geom/usd/usd_mesh_file.h"
#include "geom/usd/usd_stage.h"
#include "geom/usd/usd_validation.h"
#include "geom/usd/usd_values.h"

namespace pelage::usd_limits_test {
namespace {

/// Curves of two points, with more attributes.
std::string hair(const std::string& more, const std::string& points = "[(0, 0, 0), (0, 1, 0)]") {
  return "#usda 1.0\ndef BasisCurves \"h\" {\n uniform token type = \"linear\"\n int[] curveVertexCounts = "
         "[2]\n "
         "point3f[] points = " +
         points + "\n" + more + "\n}\n";
}

TEST(UsdLimits, PlacesOfLongFilesAreThoseOfACount) {
  std::string text = "#usda 1.0\n";
  for (int i = 0; i < 3000; ++i) text += fmt::format("def \"a{}\" {{}}{}", i, i % 7 && i < 2000 ? "\n" : " ");
  const UsdLayer layer("a.usda", text);
  for (size_t place = 0; place < text.size() + 10; place += 131) {
    const std::string before = text.substr(0, place);
    const SourcePosition at = layer.position(place);
    EXPECT_EQ(at.line, 1 + std::count(before.begin(), before.end(), '\n'));
    EXPECT_EQ(at.column, static_cast<int>(before.size() - (before.rfind('\n') + 1)) + 1);
  }
}

TEST(UsdLimits, LongElementsAreSkipped) {
  std::string ones = "1", zeros = "0";
  for (int i = 1; i < 1000; ++i) ones += ",1";
  for (int i = 1; i < 1000; ++i) zeros += ",0";
  const std::string wide = hair(
      "float[] primvars:x = [" + ones +
      "] (elementSize = 1000\n interpolation = \"vertex\")\n int[] primvars:x:indices = [" + zeros + "]");
  const UsdCurvesFile file = read_usd_curves("a.usda", wide);
  EXPECT_TRUE(file.strands.attributes.empty());
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_NE(file.warnings[0].find("more than 16 numbers per element"), std::string::npos);
  // 2,000 bytes of indices become 1,000 elements of 16 numbers, twice for a short time.
  const std::string narrow = hair(
      "float[] primvars:x = [0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15] (elementSize = 16\n interpolation = "
      "\"vertex\")\n int[] primvars:x:indices = [" +
      zeros + "]");
  try {
    read_usd_curves("a.usda", narrow, {100'000});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory) << error.what();
  }
}

TEST(UsdLimits, MeshesAreChargedPrimByPrim) {
  std::string text =
      "#usda 1.0\nclass Mesh \"m\" { int[] faceVertexCounts = [3]\n int[] faceVertexIndices = [0, 1, 2]\n "
      "point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)] }\n";
  for (int i = 0; i < 100; ++i) text += fmt::format("def \"a{}\" (references = </m>) {{}}\n", i);
  std::vector<int64_t> charges;
  const UsdMeshFile file = read_usd_mesh("a.usda", text, [&](int64_t bytes) { charges.push_back(bytes); });
  ASSERT_EQ(charges.size(), 100u);
  EXPECT_GT(charges.front(), 100);
  EXPECT_GE(charges.back(), static_cast<int64_t>(300 * sizeof(V3f)));
  int prims = 0;
  const auto stop = [&](int64_t) {
    if (++prims == 5) throw Error(ErrorKind::kStopped, "stopped");
  };
  EXPECT_THROW(read_usd_mesh("a.usda", text, stop), Error);
  EXPECT_EQ(prims, 5);
}

TEST(UsdLimits, CommentsMayBeWithinArrays) {
  const UsdCurvesFile file =
      read_usd_curves("a.usda", hair("", "[(0, 0, 0), /* it's ] */ // \"root\n # '\n (0, 1/**/, 0)]"));
  EXPECT_EQ(file.strands.points.size(), 8u);
  EXPECT_THROW(read_usd_curves("a.usda", hair("", "[(0, 0, 0), (0, 1/2, 0)]")), Error);
}

TEST(UsdLimits, NumbersMayHaveSignsAndTextsEscapes) {
  const UsdCurvesFile file =
      read_usd_curves("a.usda", hair("point3f[] points.timeSamples = { +1: [(+5, 0, 0), (0, -1, 0)] }"));
  EXPECT_EQ(file.strands.points.at(0), 5);
  EXPECT_EQ(file.strands.points.at(5), -1);
  const UsdLayer layer("a.usda", "#usda 1.0\ndef \"a\" { string s = \"a\\n\\\"\\\\n\" }");
  const UsdAttribute* s = layer.root().child("a")->find("s");
  EXPECT_EQ(usd_texts(layer, s->value), std::vector<std::string>{"a\n\"\\n"});
}

TEST(UsdLimits, FilesOfASceneAreKnown) {
  const TemporaryFolder folder;
  const auto write = [&](const char* name, const std::string& text) {
    write_file(folder.path() / name, "#usda 1.0\n" + text);
  };
  write("a.usda",
        "(subLayers = [@./b.usda@])\ndef \"p\" (references = [@none.usda@</x>]) { variantSet \"v\" = { "
        "\"x\" { def \"q\" (payload = @c.usda@) {} } } }");
  write("b.usda", "def \"p\" (references = @a.usda@</p>) {}");
  write("c.usda", "");
  const std::filesystem::path other = folder.path() / "d.obj";
  std::vector<std::filesystem::path> files;
  for (const auto& file : with_usd_files({folder.path() / "a.usda", other}))
    files.push_back(file.lexically_relative(folder.path()));
  EXPECT_EQ(files, (std::vector<std::filesystem::path>{"a.usda", "b.usda", "c.usda", "d.obj"}));
}

TEST(UsdLimits, ValidationLooksAtAllSamplesAndForCurves) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.usda";
  const auto problems = [&](const std::string& text) {
    write_file(path, text);
    std::string all;
    for (const std::string& line : validate_usd(path).problems) all += line + "\n";
    return all;
  };
  EXPECT_NE(problems("#usda 1.0\n").find("a.usda: has no curves"), std::string::npos);
  const std::string extent = "float3[] extent = [(-1, -1, -1), (2, 2, 2)]\n";
  EXPECT_EQ(problems(hair(extent + "float[] widths = [0.1] (interpolation = \"constant\")")), "");
  const std::string moving =
      problems(hair(extent + "float[] widths.timeSamples = { 1: [0.1], 2: [-1], 3: [1, 1, 1] }"));
  EXPECT_NE(moving.find("1 widths are negative or not finite at time 2"), std::string::npos) << moving;
  EXPECT_NE(moving.find("it has 3 widths at time 3"), std::string::npos) << moving;
}

}  // namespace
}  // namespace pelage::usd_limits_test
