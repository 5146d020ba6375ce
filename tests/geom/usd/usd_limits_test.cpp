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
#include "tests/support/allocation_meter.h"

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
  const CurvesFile file = read_usd_curves({"a.usda", wide});
  EXPECT_TRUE(file.strands.attributes.empty());
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_NE(file.warnings[0].find("more than 16 numbers per element"), std::string::npos);
  // 2,000 bytes of indices become 1,000 elements of 16 numbers, twice for a short time.
  const std::string narrow = hair(
      "float[] primvars:x = [0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15] (elementSize = 16\n interpolation = "
      "\"vertex\")\n int[] primvars:x:indices = [" +
      zeros + "]");
  try {
    read_usd_curves({"a.usda", narrow}, {100'000});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory) << error.what();
  }
}

/// Curves whose ids count down to `last_id`, and, if `attributes`, values of every interpolation.
std::string many_curves(const std::string& basis, const std::string& wrap, int strands, int points,
                        bool attributes = true, int last_id = 1) {
  std::string counts, places, ids, colors, uniform;
  for (int s = 0; s < strands; ++s) {
    counts += fmt::format("{},", points);
    ids += fmt::format("{},", last_id + strands - 1 - s);
    uniform += "(1,2),";
  }
  for (int i = 0; i < strands * points; ++i) {
    places += fmt::format("({},{},0),", i % 7, i % 3);
    colors += "(1,0,1),";
  }
  std::string text = fmt::format(
      "def BasisCurves \"{0}{1}\" {{ uniform token basis = \"{0}\"\n uniform token wrap = \"{1}\"\n"
      "int[] curveVertexCounts = [{2}]\n point3f[] points = [{3}]\n"
      "int[] primvars:ids = [{4}] (interpolation = \"uniform\")\n",
      basis, wrap, counts, places, ids);
  if (attributes) {
    text += fmt::format(
        "color3f[] primvars:displayColor = [{}] (interpolation = \"vertex\")\n"
        "float2[] primvars:st = [{}] (interpolation = \"uniform\")\n"
        "float primvars:{} = 1 (interpolation = \"constant\")\n",
        colors, uniform, basis);
  }
  return text + "}\n";
}

TEST(UsdLimits, TheLimitOfMemoryHoldsForAllThatIsTaken) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.usda";
  // Curves that keep their vertices, that are resampled, and of two bases, which are all resampled: without
  // attributes, their points are six times as many as in the file, twice while they are sorted.
  const std::string pinned = many_curves("bspline", "pinned", 2000, 8),
                    bezier = many_curves("bezier", "nonperiodic", 2000, 7),
                    long_one = many_curves("catmullRom", "nonperiodic", 1, 16'000),
                    plain = many_curves("bspline", "pinned", 2000, 8, false),
                    others = many_curves("catmullRom", "pinned", 2000, 8, false, 2001);
  for (const std::string& curves :
       {pinned, bezier, long_one, pinned + bezier, bezier + long_one, plain + others}) {
    write_file(path, "#usda 1.0\n" + curves);
    reset_peak();
    const size_t before = live_bytes();
    read_usd_curves(path);
    const size_t peak = peak_bytes() - before;
    // 64 KiB: prims and paths, which are not counted.
    EXPECT_THROW(read_usd_curves(path, {static_cast<int64_t>(peak - (1 << 16))}), Error)
        << curves.substr(0, 60);
    // Text is charged as if it had a number in every other byte.
    EXPECT_NO_THROW(read_usd_curves(path, {static_cast<int64_t>(4 * peak)})) << curves.substr(0, 60);
  }
}

TEST(UsdLimits, AFileMayBeCutWhileItIsOpen) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.usda";
  const std::string points = "[(0, 0, 0), (0, 1, 0)]";
  write_file(path, hair(std::string(100'000, ' '), points));
  const UsdLayer layer(path);
  std::filesystem::resize_file(path, 0);
  const UsdAttribute* attribute = layer.root().child("h")->find("points");
  EXPECT_EQ(usd_floats(layer, attribute->value, 3), (std::vector<float>{0, 0, 0, 0, 1, 0}));
  EXPECT_EQ(layer.position(layer.text().size()).line, 8);
}

TEST(UsdLimits, TheTextOfFilesIsCharged) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.usda";
  write_file(path, hair("# " + std::string(100'000, 'x') + "\n"));
  EXPECT_NO_THROW(read_usd_curves(path, {120'000}));
  EXPECT_THROW(read_usd_curves(path, {90'000}), Error);
  write_file(folder.path() / "b.usda",
             "#usda 1.0\n# " + std::string(100'000, 'x') +
                 "\ndef Mesh \"m\" { int[] faceVertexCounts = [3]\n int[] "
                 "faceVertexIndices = [0, 1, 2]\n point3f[] points = [(0, 0, 0), (1, "
                 "0, 0), (0, 1, 0)] }\n");
  std::vector<int64_t> charges;
  read_usd_mesh(folder.path() / "b.usda", [&](int64_t bytes) { charges.push_back(bytes); });
  ASSERT_EQ(charges.size(), 2u);
  EXPECT_GT(charges.front(), 100'000);
  EXPECT_GT(charges.back(), charges.front());
}

TEST(UsdLimits, MeshesAreChargedPrimByPrim) {
  std::string text =
      "#usda 1.0\nclass Mesh \"m\" { int[] faceVertexCounts = [3]\n int[] faceVertexIndices = [0, 1, 2]\n "
      "point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)] }\n";
  for (int i = 0; i < 100; ++i) text += fmt::format("def \"a{}\" (references = </m>) {{}}\n", i);
  std::vector<int64_t> charges;
  const MeshFile file = read_usd_mesh({"a.usda", text}, [&](int64_t bytes) { charges.push_back(bytes); });
  ASSERT_EQ(charges.size(), 100u);
  EXPECT_GT(charges.front(), 100);
  EXPECT_GE(charges.back(), static_cast<int64_t>(300 * sizeof(V3f)));
  int prims = 0;
  const auto stop = [&](int64_t) {
    if (++prims == 5) throw Error(ErrorKind::kStopped, "stopped");
  };
  EXPECT_THROW(read_usd_mesh({"a.usda", text}, stop), Error);
  EXPECT_EQ(prims, 5);
}

TEST(UsdLimits, CommentsMayBeWithinArrays) {
  const CurvesFile file =
      read_usd_curves({"a.usda", hair("", "[(0, 0, 0), /* it's ] */ // \"root\n # '\n (0, 1/**/, 0)]")});
  EXPECT_EQ(file.strands.points.size(), 8u);
  EXPECT_THROW(read_usd_curves({"a.usda", hair("", "[(0, 0, 0), (0, 1/2, 0)]")}), Error);
}

TEST(UsdLimits, NumbersMayHaveSignsAndTextsEscapes) {
  const CurvesFile file =
      read_usd_curves({"a.usda", hair("point3f[] points.timeSamples = { +1: [(+5, 0, 0), (0, -1, 0)] }")});
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
