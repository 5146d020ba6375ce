// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usd_stage.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/file.h"
#include "base/temporary_folder.h"
#include "geom/io/mesh_file.h"
#include "geom/usd/usd_mesh_file.h"
#include "geom/usd/usd_values.h"

namespace pelage::usd_stage_test {
namespace {

constexpr const char* kTriangle = R"(
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0, 1, 2]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
)";

class UsdFiles : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    write_file(folder_.path() / name, "#usda 1.0\n" + text);
    return folder_.path() / name;
  }
  ControlMesh mesh(const std::string& text) { return read_mesh_file(write("a.usda", text)); }
  std::string refusal(const std::string& text) {
    try {
      mesh(text);
    } catch (const Error& error) {
      std::string what = error.what();
      const std::string folder = folder_.path().string() + "/";
      for (size_t at; (at = what.find(folder)) != std::string::npos;) what.erase(at, folder.size());
      return what;
    }
    return "accepted";
  }
  const TemporaryFolder folder_;
};

TEST_F(UsdFiles, ComposesReferencesPayloadsSublayersVariantsAndClasses) {
  write("leaf.usda", "(defaultPrim = \"m\")\ndef Mesh \"m\" {" + std::string(kTriangle) + "}");
  write("under.usda", "over \"top\" { over \"m\" { int[] holeIndices = [0] } }");
  const ControlMesh read = mesh(R"((subLayers = [@under.usda@])
class "moved" { double3 xformOp:translate = (0, 0, 5)
  uniform token[] xformOpOrder = ["xformOp:translate"] }
def Xform "top" (variants = { string where = "here" }; prepend variantSets = "where")
{
  def "m" (prepend references = @leaf.usda@) {}
  def "p" (payload = @leaf.usda@</m>; inherits = </moved>) {}
  variantSet "where" = {
    "away" { def Mesh "never" {} }
    "here" { def "v" (references = [@leaf.usda@]) {} }
  }
}
)");
  ASSERT_EQ(read.face_count(), 3u);
  EXPECT_EQ(read.objects.names, (std::vector<std::string>{"m", "p", "v"}));
  EXPECT_EQ(read.holes, std::vector<uint32_t>{0});
  EXPECT_EQ(read.positions[3], V3f(0, 0, 5));
}

TEST_F(UsdFiles, OpensLayersOnDemand) {
  write("leaf.usda", "(defaultPrim = \"m\")\ndef Mesh \"m\" {" + std::string(kTriangle) + "}");
  std::string text = "def Xform \"all\" {";
  for (int i = 0; i < 200; ++i) text += fmt::format("def \"m{}\" (payload = @leaf.usda@) {{}}\n", i);
  EXPECT_EQ(mesh(text + "}").face_count(), 200u);
}

TEST_F(UsdFiles, TransformsAreAppliedLastOperationFirst) {
  const std::string ops = R"(def Xform "a" {
  double3 xformOp:translate = (10, 0, 0)
  float xformOp:rotateZ = 90
  float3 xformOp:scale = (2, 2, 2)
  uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateZ", "xformOp:scale"]
  def Mesh "m" {)";
  const ControlMesh read = mesh(ops + kTriangle + "} }");
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(read.positions[1][axis], V3f(10, 2, 0)[axis], 1e-5);  // (2, 0, 0) turned
    EXPECT_NEAR(read.positions[2][axis], V3f(8, 0, 0)[axis], 1e-5);
  }
  const ControlMesh inverse = mesh(
      "def Mesh \"m\" { matrix4d xformOp:transform:a = ( (1,0,0,0), (0,1,0,0), (0,0,1,0), (0,0,7,1) )\n "
      "uniform "
      "token[] xformOpOrder = [\"!invert!xformOp:transform:a\"]" +
      std::string(kTriangle) + "}");
  EXPECT_EQ(inverse.positions[0], V3f(0, 0, -7));
  const ControlMesh up = mesh("(upAxis = \"Z\")\ndef Mesh \"m\" {" + std::string(kTriangle) + "}");
  EXPECT_EQ(up.positions[2], V3f(0, 0, -1));
}

TEST_F(UsdFiles, ReadsSubdivisionTags) {
  const ControlMesh read = mesh(R"(def Mesh "m" {
  int[] faceVertexCounts = [4, 3]
  int[] faceVertexIndices = [0, 1, 2, 3, 3, 2, 4]
  point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 2, 0)]
  int[] creaseIndices = [0, 1, 2, 3, 4]
  int[] creaseLengths = [3, 2]
  float[] creaseSharpnesses = [2, 3]
  int[] cornerIndices = [4]
  float[] cornerSharpnesses = [10]
  int[] holeIndices = [1]
  uniform token interpolateBoundary = "edgeOnly"
  texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1), (0, 2)] (interpolation = "vertex")
  def GeomSubset "belly" { int[] indices = [1] }
})");
  ASSERT_EQ(read.creases.size(), 3u);
  EXPECT_EQ(read.creases[1].a, 1u);
  EXPECT_EQ(read.creases[1].b, 2u);
  EXPECT_EQ(read.creases[1].sharpness, 2);
  EXPECT_EQ(read.creases[2].sharpness, 3);
  EXPECT_EQ(read.corners.at(0).vertex, 4u);
  EXPECT_EQ(read.holes, std::vector<uint32_t>{1});
  EXPECT_EQ(read.boundary_tag, 2);
  EXPECT_EQ(read.uv[read.face_uv[6]], V2f(0, 2));
  EXPECT_EQ(read.groups.at(read.face_groups.at(1)), "belly");
}

TEST_F(UsdFiles, MirroredAndLeftHandedFacesAreTurned) {
  const ControlMesh left =
      mesh("def Mesh \"m\" { uniform token orientation = \"leftHanded\"" + std::string(kTriangle) + "}");
  EXPECT_EQ(left.face_vertices, (std::vector<uint32_t>{2, 1, 0}));
}

TEST_F(UsdFiles, SkipsTheRestWithOneWarningPerKind) {
  const MeshFile file =
      read_usd_mesh({"a.usda", "#usda 1.0\ndef Cube \"a\" {}\ndef Cube \"b\" {}\ndef Mesh \"m\" {" +
                                   std::string(kTriangle) + "}\ndef PointInstancer \"p\" {}\n"});
  EXPECT_EQ(file.warnings, (std::vector<std::string>{"a.usda:2:10: Cube prims are skipped (2 times)",
                                                     "a.usda:9:20: PointInstancer prims are skipped"}));
}

TEST_F(UsdFiles, RefusesMalformedFilesInOneLine) {
  EXPECT_EQ(refusal("def Mesh \"m\" {"), "a.usda:2:15: expected a name, but the file ends");
  EXPECT_EQ(refusal("def Mesh \"m\" { int[] a = [1, 2 }"), "a.usda:2:32: expected ']', found '}'");
  EXPECT_EQ(refusal("def Mesh \"m {}"), "a.usda:2:10: the text has no closing quote");
  EXPECT_EQ(refusal("def \"a\" ( \"\"\"abc\\"), "a.usda:2:11: the text has no closing quotes");
  EXPECT_EQ(refusal("def \"a\" { string s = \"abc\\"), "a.usda:2:22: the text has no closing quote");
  EXPECT_EQ(refusal("dif Mesh"), "a.usda:2:1: expected 'def', 'over' or 'class'");
  EXPECT_EQ(refusal("def \"a\" (references = @b.usda@) {}"), "a.usda:2:23: 'b.usda': there is no such file");
  EXPECT_EQ(refusal("def \"a\" (references = </b>) {}"), "a.usda:2:23: there is no prim </b>");
  EXPECT_NE(refusal("def \"a\" (references = </a>) {}").find("</a> refers to itself"), std::string::npos);
  EXPECT_NE(refusal("def \"a\" { def \"b\" (references = </a>) {} }").find("</a> refers to itself"),
            std::string::npos);
  EXPECT_NE(refusal("(subLayers = [@a.usda@])").find("sublayers contain themselves"), std::string::npos);
  std::string deep;
  for (int i = 0; i < 100; ++i) deep += "def \"a\" { ";
  EXPECT_NE(refusal(deep).find("prims are nested deeper than 64 levels"), std::string::npos);
  EXPECT_NE(refusal("def \"a\" { int a = " + std::string(100, '[')).find("brackets are nested deeper"),
            std::string::npos);
  EXPECT_EQ(
      refusal(
          "def Mesh \"m\" {\n int[] faceVertexCounts = [3]\n int[] faceVertexIndices = [0, 1, 9]\n point3f[] "
          "points = [(0, 0, 0)]\n}"),
      "a.usda:4:8: the index 1 is not one of 1 points");
}

TEST_F(UsdFiles, RefusesEndlessScenes) {
  std::string deep;
  for (int i = 0; i < 20; ++i) {
    deep += fmt::format("{} \"a{}\" {{", i ? "class" : "def", i);
    for (int level = 0; level < 60; ++level) deep += "def \"d\" {";
    deep += fmt::format("def \"e\" (references = </a{}>) {{}}", i + 1) + std::string(61, '}') + "\n";
  }
  EXPECT_NE(refusal(deep + "class \"a20\" {}").find("prims are nested deeper than 512 levels"),
            std::string::npos);
  write("b.usda", "(subLayers = [@a.usda@])");
  EXPECT_EQ(refusal("(subLayers = [@b.usda@])"), "b.usda:2:15: sublayers contain themselves");
  std::string wide = "class \"c0\" {}\n";
  for (int i = 1; i < 20; ++i)
    wide += fmt::format("class \"c{0}\" (references = [</c{1}>, </c{1}>]) {{}}\n", i, i - 1);
  EXPECT_NE(refusal(wide).find("refers to too many prims"), std::string::npos);
}

TEST_F(UsdFiles, StrongerOpinionsComeFirst) {
  // Each prim gives another x to the first point.
  const auto prim = [](const std::string& head, int x) {
    const std::string points =
        x < 0 ? "" : fmt::format("point3f[] points = [({}, 0, 0), (1, 0, 0), (0, 1, 0)]", x);
    return head + " { int[] faceVertexCounts = [3]\n int[] faceVertexIndices = [0, 1, 2]\n" + points + "}\n";
  };
  const std::string a = prim("class Mesh \"A\" (references = </C>)", -1), b = prim("class Mesh \"B\"", 3),
                    c = prim("class Mesh \"C\"", 7);
  const auto first = [&](const std::string& arcs) {
    return mesh(prim("def Mesh \"P\" (" + arcs + ")", -1) + a + b + c).positions.at(0).x;
  };
  EXPECT_EQ(first("references = [</A>, </B>]"), 7);
  EXPECT_EQ(first("references = </C>\n inherits = </B>"), 3);
  EXPECT_EQ(first("references = </C>\n specializes = </B>"), 7);
  EXPECT_EQ(first("payload = </B>\n references = </A>"), 7);
  // What a prim inherits itself is stronger than what a reference of its parent states.
  const std::string nested =
      "def \"P\" (references = </R>) { over \"m\" (inherits = </B>) {} }\n"
      "class \"R\" { " +
      prim("def Mesh \"m\"", 7) + "}\n";
  EXPECT_EQ(mesh(nested + b).positions.at(0).x, 3);
  // A selection may be weaker than its variant set.
  const std::string chosen = prim("class Mesh \"V\" (variants = { string s = \"two\" })", 5) +
                             "def \"P\" (references = </V>; variantSets = \"s\") { variantSet \"s\" = { "
                             "\"one\" {} \"two\" { point3f[] "
                             "points = [(9, 0, 0), (1, 0, 0), (0, 1, 0)] } } }";
  EXPECT_EQ(mesh(chosen).positions.at(0).x, 9);
}

TEST_F(UsdFiles, ManyPrimsMayInheritOneClass) {
  std::string nested = "class \"c\" {}\n", close = "}";
  for (int i = 0; i < 6; ++i, close += "}") nested += fmt::format("def \"a{}\" (inherits = </c>) {{ ", i);
  EXPECT_EQ(mesh(nested + "def Mesh \"m\" {" + kTriangle + close).face_count(), 1u);
  std::string classes = "def \"p\" (references = [</a0>, </a1>, </a2>, </a3>, </a4>]) {}\n";
  for (int i = 0; i < 5; ++i) classes += fmt::format("class \"a{}\" (inherits = </c>) {{}}\n", i);
  EXPECT_EQ(mesh(classes + "class Mesh \"c\" {" + kTriangle + "}").face_count(), 1u);
}

TEST_F(UsdFiles, TimeSamplesBeatDefaultValues) {
  const ControlMesh read = mesh(
      "def Mesh \"m\" { point3f[] points.timeSamples = { 2: [(9, 0, 0), (9, 0, 0), (9, "
      "0, 0)], 1: [(5, 0, 0), (1, 0, 0), (0, 1, 0)] }" +
      std::string(kTriangle) + "}");
  EXPECT_EQ(read.positions.at(0).x, 5);
}

TEST_F(UsdFiles, NamesBinaryFilesAndTheCommandThatConvertsThem) {
  write_file(folder_.path() / "b.usdc", "PXR-USDC\x01\x02");
  try {
    read_mesh_file(folder_.path() / "b.usdc");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("usdcat"), std::string::npos);
  }
}

TEST(UsdValues, KnowsTheNumbersOfTypes) {
  EXPECT_EQ(usd_components("point3f"), 3u);
  EXPECT_EQ(usd_components("texCoord2h"), 2u);
  EXPECT_EQ(usd_components("color4d"), 4u);
  EXPECT_EQ(usd_components("int64"), 1u);
  EXPECT_EQ(usd_components("int2"), 2u);
  EXPECT_EQ(usd_components("matrix4d"), 16u);
  EXPECT_EQ(usd_components("token"), 0u);
  EXPECT_EQ(usd_components("asset"), 0u);
}

}  // namespace
}  // namespace pelage::usd_stage_test
