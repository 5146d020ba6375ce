// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/corpus.h"

namespace pelage {

std::vector<std::string> usd_corpus() {
  const std::string curves = R"(#usda 1.0
(defaultPrim = "a"; upAxis = "Z")
def Xform "a" (variants = { string v = "x" }; prepend variantSets = "v"; inherits = </c>)
{
  float3 xformOp:rotateXYZ = (10, 20, 30)
  uniform token[] xformOpOrder = ["xformOp:rotateXYZ", "!invert!xformOp:rotateXYZ"]
  variantSet "v" = { "x" { def BasisCurves "h" {
    uniform token basis = "bspline"
    uniform token wrap = "pinned"
    int[] curveVertexCounts = [3, 2]
    point3f[] points.timeSamples = { 1: [(0, 0, 0), (1, 1, 0), (2, 0, 1), (0, 0, 0), (1, 0, 0)], 2: None, }
    float[] widths = [0.1, 0.2, 0.3, 0.4, 0.5] (interpolation = "vertex")
    int64[] primvars:ids = [7, 3] (interpolation = "uniform")
    texCoord2f[] primvars:st = [(0, 0.5), (1, 0.5)] (interpolation = "uniform")
    color3f[] primvars:displayColor = [(1, 0, 0), (0, 1, 0)] (interpolation = "varying")
    int[] primvars:displayColor:indices = [0, 1, 1, 0, 1]
    float[] primvars:two = [1, 2, 3, 4] (elementSize = 2; interpolation = "uniform")
  } } }
  def BasisCurves "b" { int[] curveVertexCounts = [4]; point3f[] points = [(0,0,0),(1,0,0),(1,1,0),(0,1,0)] }
}
class "c" { double3 xformOp:translate = (1, 2, 3) }
)";
  const std::string mesh = R"(#usda 1.0
def Mesh "m" {
  int[] faceVertexCounts = [4, 3]
  int[] faceVertexIndices = [0, 1, 2, 3, 3, 2, 4]
  point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 2, 0)]
  int[] creaseIndices = [0, 1, 2]
  int[] creaseLengths = [3]
  float[] creaseSharpnesses = [2]
  int[] holeIndices = [1]
  texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1), (0, 2)] (interpolation = "vertex")
  color3f[] primvars:displayColor = [(0,0,0),(0,0,0),(1,0,0),(0,0,0),(0,0,0)] (interpolation = "vertex")
  def GeomSubset "s" { int[] indices = [0] }
})";
  std::vector<std::string> corpus{curves, mesh};
  const auto add = [&](const std::string& text) { corpus.push_back("#usda 1.0\n" + text); };
  add("def BasisCurves \"c\" { int[] curveVertexCounts = [1000000000]\n point3f[] points = [(0, 0, 0)] }");
  add("def BasisCurves \"c\" { int[] curveVertexCounts = [-1, 99999999999999999999]\n point3f[] points = [] "
      "}");
  add("def \"a\" (references = </a>) {}");
  add("def \"a\" { def \"b\" (references = </a>) {} def \"c\" (references = </a>) {} }");
  add("class \"a\" (inherits = [</b>, </b>]) {} class \"b\" (inherits = [</a>, </a>]) {} def \"d\" (inherits "
      "= </a>) {}");
  add("(subLayers = [@/dev/zero@, @.@])");
  std::string deep, variants;
  for (int i = 0; i < 5000; ++i) deep += "def \"a\" { ";
  add(deep);
  for (int i = 0; i < 5000; ++i) variants += "variantSet \"a\" = { \"b\" { ";
  add("def \"a\" { " + variants);
  add("def \"a\" { int a = " + std::string(100000, '['));
  add("def \"a\" { string s = \"\"\"" + std::string(1000, 'x'));
  add(std::string(1 << 20, ' '));
  add(std::string(1 << 16, '('));
  add("def Mesh \"m\" { int[] faceVertexCounts = [3]\n int[] faceVertexIndices = [0, 0, 0]\n point3f[] "
      "points = [(inf, nan, "
      "1e999)] }");
  add("def BasisCurves \"c\" { uniform token type = \"linear\"\n uniform token wrap = \"periodic\"\n int[] "
      "curveVertexCounts = [0, 1, 0]\n point3f[] points = [(0, 0, 0)]\n texCoord2f[] primvars:st = [] }");
  // One leaf that many prims refer to.
  std::string many =
      "class \"l\" { def BasisCurves \"c\" { int[] curveVertexCounts = [4]\n point3f[] points = "
      "[(0,0,0),(1,0,0),(1,1,0),(0,1,0)] } }\n";
  for (int i = 0; i < 10; ++i) {
    const std::string inner = i == 0 ? "l" : "n" + std::to_string(i - 1);
    many += "class \"n" + std::to_string(i) + "\" {";
    for (int k = 0; k < 8; ++k)
      many += "def \"k" + std::to_string(k) + "\" (references = </" + inner + ">) {}\n";
    many += "}\n";
  }
  add(many + "def \"top\" (references = </n3>) {}");
  return corpus;
}

}  // namespace pelage
