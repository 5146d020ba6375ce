// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "base/file.h"
#include "base/temporary_folder.h"
#include "geom/curve.h"
#include "geom/io/strand_file.h"
#include "geom/usd/usd_curves_file.h"
#include "geom/usd/usd_curves_writer.h"
#include "tests/geom/attributed_strands.h"

namespace pelage::usd_curves_test {
namespace {

CurvesFile read(const std::string& text) { return read_usd_curves({"a.usda", "#usda 1.0\n" + text}); }

/// The message of the error that reading a text throws.
std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.problems().size(), 1u);
    return error.what();
  }
  return "accepted";
}

/// A curve with these tokens through the points (0, 0, 0), (1, 1, 0), (2, 0, 0) and so on.
std::string zigzag(const std::string& type, const std::string& basis, const std::string& wrap, int n,
                   const std::string& more = "") {
  std::string points;
  for (int i = 0; i < n; ++i) points += fmt::format("({}, {}, 0), ", i, i % 2);
  return fmt::format(
      "def BasisCurves \"c\" {{\n uniform token type = \"{}\"\n uniform token basis = \"{}\"\n uniform token "
      "wrap = \"{}\"\n int[] curveVertexCounts = [{}]\n point3f[] points = [{}]\n{}\n}}\n",
      type, basis, wrap, n, points, more);
}

void expect_equal(const StrandArrays& read, const StrandArrays& written) {
  EXPECT_EQ(read.basis, written.basis);
  EXPECT_EQ(read.first_point, written.first_point);
  EXPECT_EQ(read.ids, written.ids);
  EXPECT_EQ(read.root_uv, written.root_uv);
  ASSERT_EQ(read.points.size(), written.points.size());
  // Widths are written, and halving them is exact.
  for (size_t i = 0; i < read.points.size(); ++i) EXPECT_EQ(read.points[i], written.points[i]) << i;
  ASSERT_EQ(read.attributes.size(), written.attributes.size());
  for (const StrandAttribute& attribute : written.attributes) {
    const auto same =
        std::find_if(read.attributes.begin(), read.attributes.end(),
                     [&](const StrandAttribute& other) { return other.name == attribute.name; });
    ASSERT_NE(same, read.attributes.end()) << attribute.name;
    EXPECT_EQ(same->frequency, attribute.frequency) << attribute.name;
    EXPECT_EQ(same->components, attribute.components) << attribute.name;
    EXPECT_EQ(same->values, attribute.values) << attribute.name;
  }
}

TEST(UsdCurves, RoundTripKeepsEverything) {
  const TemporaryFolder folder;
  for (const CurveBasis basis :
       {CurveBasis::kPinnedBSpline, CurveBasis::kBSpline, CurveBasis::kLinear, CurveBasis::kCatmullRom}) {
    const StrandArrays written = attributed_strands(basis);
    const std::filesystem::path path = folder.path() / "a.usda";
    write_strands(path, Strands(written));
    const CurvesFile file = read_usd_curves(path);
    EXPECT_TRUE(file.has_widths);
    EXPECT_TRUE(file.warnings.empty());
    expect_equal(file.strands, written);
    EXPECT_EQ(what_is_lost(path, Strands(written)), "");
  }
}

TEST(UsdCurves, PlainCurvesHaveTheValuesOfTransformedOnes) {
  // Curves that are moved take the way of resampled ones.
  const auto with = [&](const std::string& basis, const std::string& wrap, float shift) {
    const std::string values =
        "\n color3f[] primvars:displayColor = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (1, 0, 1)] "
        "(interpolation = "
        "\"vertex\")\n float[] primvars:all = [3] (interpolation = \"constant\")\n float2[] primvars:each = "
        "[(5, 6)] (interpolation = \"uniform\")\n float[] primvars:between = " +
        std::string(wrap == "pinned" ? "[1, 2, 3, 4, 5]" : "[1, 2, 3]") + " (interpolation = \"varying\")";
    return read(fmt::format("def Xform \"x\" {{ double3 xformOp:translate = ({}, 0, 0)\n uniform token[] "
                            "xformOpOrder = "
                            "[\"xformOp:translate\"]\n{}}}",
                            shift, zigzag("cubic", basis, wrap, 5, values)))
        .strands;
  };
  for (const auto& [basis, wrap] :
       {std::pair{"bspline", "pinned"}, {"bspline", "nonperiodic"}, {"catmullRom", "pinned"}}) {
    const StrandArrays plain = with(basis, wrap, 0), moved = with(basis, wrap, 8);
    EXPECT_EQ(plain.points[4], 1);
    EXPECT_EQ(moved.points[4], 9);
    ASSERT_EQ(plain.attributes.size(), 4u);
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(plain.attributes[i].frequency, moved.attributes[i].frequency);
      EXPECT_EQ(plain.attributes[i].values, moved.attributes[i].values) << plain.attributes[i].name << basis;
    }
  }
}

TEST(UsdCurves, StrandsAreSortedByTheirIds) {
  const TemporaryFolder folder;
  StrandArrays written = attributed_strands(CurveBasis::kPinnedBSpline);
  const StrandArrays sorted = written;
  // The same strands in reverse, with their ids.
  UsdCurvesFacts facts;
  const std::filesystem::path path = folder.path() / "a.usda";
  const Strands strands(std::move(written));
  UsdWriter usd(path, "");
  for (size_t s = strands.strand_count(); s-- > 0;) {
    Strands one;
    one.assign_strand(strands, s);
    write_usd_curves(usd, fmt::format("s{}", s), facts, 1, [&](size_t) { return UsdCurvesSample{one, {}}; });
  }
  usd.commit();
  CurvesFile file = read_usd_curves(path);
  // What is constant in each of several prims may differ between them.
  for (StrandAttribute& attribute : file.strands.attributes) {
    if (attribute.name != "clump:size") continue;
    EXPECT_EQ(attribute.frequency, AttributeClass::kPerStrand);
    attribute.frequency = AttributeClass::kConstant;
    attribute.values.resize(2);
  }
  expect_equal(file.strands, sorted);
}

/// The max distance between points of ours on a strand and the curve that `exact(x)` describes, sampled.
double distance_to(const StrandArrays& arrays, const std::function<V3f(float t)>& exact) {
  const Strands strands(arrays);
  double worst = 0;
  const uint32_t segments = segment_count(strands.basis(), strands.strand_points(0));
  for (uint32_t s = 0; s < segments; ++s) {
    for (const float t : {0.0f, 0.25f, 0.5f, 0.75f}) {
      const V3f p = curve_position(bezier_segment(strands, 0, s), t);
      double nearest = 1e9;
      for (float u = 0; u <= 1.0f; u += 1 / 4096.0f)
        nearest = std::min(nearest, double((exact(u) - p).length()));
      worst = std::max(worst, nearest);
    }
  }
  return worst;
}

TEST(UsdCurves, BezierCurvesAreResampled) {
  const CurvesFile file = read(zigzag("cubic", "bezier", "nonperiodic", 4,
                                      " float[] widths = [0.1, 0.2] (interpolation = \"varying\")"));
  EXPECT_EQ(file.strands.basis, CurveBasis::kCatmullRom);
  ASSERT_EQ(file.strands.points.size(), 28u);
  EXPECT_FLOAT_EQ(file.strands.points[3], 0.05f);
  EXPECT_FLOAT_EQ(file.strands.points[27], 0.1f);
  const auto exact = [](float t) {
    const float s = 1 - t;
    return V3f(3 * t, 3 * s * s * t + t * t * t, 0);
  };
  // The cubic has a length of about 3.3. The end segments, which lack a neighbour, differ most: by 4 % of the
  // length of a segment.
  EXPECT_LT(distance_to(file.strands, exact), 0.02);
}

TEST(UsdCurves, PeriodicCurvesAreClosed) {
  const StrandArrays linear = read(zigzag("linear", "bezier", "periodic", 3)).strands;
  EXPECT_EQ(linear.basis, CurveBasis::kLinear);
  ASSERT_EQ(linear.points.size(), 16u);
  EXPECT_EQ(linear.points[12], 0);
  const StrandArrays spline = read(zigzag("cubic", "bspline", "periodic", 5)).strands;
  EXPECT_EQ(spline.basis, CurveBasis::kBSpline);
  ASSERT_EQ(spline.points.size(), 4 * 8u);
  EXPECT_EQ(spline.points[4 * 7], 2);  // x of the third vertex again
}

TEST(UsdCurves, OtherFormsAreResampledAlike) {
  for (const char* basis : {"bspline", "catmullRom", "bezier"}) {
    for (const char* wrap : {"nonperiodic", "pinned", "periodic"}) {
      const CurvesFile file = read(zigzag("cubic", basis, wrap, 7));
      ASSERT_GT(file.strands.points.size(), 0u) << basis << wrap;
      for (const float x : file.strands.points) EXPECT_TRUE(std::isfinite(x));
    }
  }
  // Two prims of different bases share the basis of resampled curves, which go through the ends of pinned
  // ones.
  const CurvesFile both = read("def \"a\" {" + zigzag("cubic", "bspline", "pinned", 5) + "}\ndef \"b\" {" +
                               zigzag("linear", "bezier", "nonperiodic", 2) + "}");
  EXPECT_EQ(both.strands.basis, CurveBasis::kCatmullRom);
  ASSERT_EQ(both.strands.first_point, (std::vector<uint32_t>{0, 25, 32}));
  EXPECT_FLOAT_EQ(both.strands.points[4 * 24], 4);
  EXPECT_NEAR(both.strands.points[4 * 26], 1 / 6.0, 1e-6);
}

TEST(UsdCurves, ReadsPrimvarsOfAllInterpolations) {
  const std::string more = R"(
 float[] widths = [0.5] (interpolation = "constant")
 texCoord2f[] primvars:st = [(0.25, 0.75)] (interpolation = "uniform")
 color3f[] primvars:displayColor = [(1, 0, 0), (0, 1, 0)] (interpolation = "vertex")
 int[] primvars:displayColor:indices = [0, 1, 1, 0]
 float primvars:mass = 3 (interpolation = "constant")
 float[] primvars:wave = [1, 2, 3, 4] (interpolation = "varying")
 string primvars:groom:coat = "x" (interpolation = "constant")
)";
  const StrandArrays a = read(zigzag("cubic", "bspline", "pinned", 4, more)).strands;
  EXPECT_EQ(a.points[3], 0.25f);
  EXPECT_EQ(a.root_uv.at(0), V2f(0.25f, 0.75f));
  ASSERT_EQ(a.attributes.size(), 3u);
  EXPECT_EQ(a.attributes[0].name, "color");
  EXPECT_EQ(a.attributes[0].values, (std::vector<float>{1, 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0}));
  EXPECT_EQ(a.attributes[1].frequency, AttributeClass::kConstant);
  EXPECT_EQ(a.attributes[2].values, (std::vector<float>{1, 2, 3, 4}));
}

TEST(UsdCurves, ExtentsContainTheCurves) {
  const TemporaryFolder folder;
  for (const CurveBasis basis : {CurveBasis::kPinnedBSpline, CurveBasis::kCatmullRom, CurveBasis::kLinear}) {
    RandomStrandOptions options;
    options.basis = basis;
    options.motion_keys = 3;
    const Strands strands = random_strands(3, options);
    for (int key = 0; key < 3; ++key) {
      const Box3f extent = usd_extent(strands, key);
      for (size_t s = 0; s < strands.strand_count(); ++s) {
        for (uint32_t i = 0; i < segment_count(basis, strands.strand_points(s)); ++i) {
          for (float t = 0; t <= 1; t += 0.125f) {
            const CubicSegment segment = bezier_segment(strands, s, i, key);
            const V3f at = curve_position(segment, t), radius(curve_radius(segment, t));
            EXPECT_TRUE(extent.intersects(at + radius)) << key;
            EXPECT_TRUE(extent.intersects(at - radius)) << key;
          }
        }
      }
    }
  }
}

TEST(UsdCurves, MotionKeysBecomeTimeSamples) {
  const TemporaryFolder folder;
  RandomStrandOptions options;
  options.motion_keys = 2;
  const std::filesystem::path path = folder.path() / "a.usda";
  write_strands(path, random_strands(3, options));
  const std::string text = read_file(path);
  EXPECT_NE(text.find("points.timeSamples"), std::string::npos);
  EXPECT_NE(text.find("extent.timeSamples"), std::string::npos);
  const CurvesFile file = read_usd_curves(path);
  EXPECT_EQ(file.strands.points.size(), random_strands(3, options).points(0).size());
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_NE(file.warnings[0].find("time samples after the first are skipped"), std::string::npos);
}

TEST(UsdCurves, RefusesWhatDoesNotFit) {
  EXPECT_EQ(
      refusal("def BasisCurves \"c\" {\n int[] curveVertexCounts = [3]\n point3f[] points = [(0, 0, 0)]\n}"),
      "a.usda:3:8: curveVertexCounts need more than the 1 points");
  EXPECT_EQ(
      refusal("def BasisCurves \"c\" {\n int[] curveVertexCounts = [1]\n point3f[] points = [(0, 0)]\n}"),
      "a.usda:4:27: expected tuples of 3 numbers");
  EXPECT_EQ(
      refusal(
          "def BasisCurves \"c\" {\n int[] curveVertexCounts = [1e9]\n point3f[] points = [(0, 0, 0)]\n}"),
      "a.usda:3:30: expected a number");
  EXPECT_EQ(refusal("def BasisCurves \"c\" {\n uniform token basis = \"bsplin\"\n}"),
            "a.usda:2:17: </c>: unknown curves: type 'cubic', basis 'bsplin', wrap 'nonperiodic'");
  EXPECT_EQ(
      refusal("def BasisCurves \"c\" {\n int[] curveVertexCounts = [-4]\n point3f[] points = [(0, 0, 0)]\n}"),
      "a.usda:3:8: a curve has -4 points (curveVertexCounts)");
  EXPECT_EQ(refusal("def Mesh \"c\" {}"), "a.usda: has no curves");
  EXPECT_EQ(refusal(zigzag("linear", "bezier", "nonperiodic", 3, " float[] widths = [1, 2]")),
            "a.usda:8:10: 'widths' has 2 values; 3 vertices, 1 curves or faces need others");
}

TEST(UsdCurves, RespectsTheMemoryLimit) {
  const std::string text = "#usda 1.0\n" + zigzag("linear", "bezier", "nonperiodic", 1000);
  EXPECT_NO_THROW(read_usd_curves({"a.usda", text}, {300'000}));
  try {
    read_usd_curves({"a.usda", text}, {10'000});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
  }
}

TEST(UsdCurves, MissingWidthsStayUnstated) {
  EXPECT_FALSE(read(zigzag("linear", "bezier", "nonperiodic", 3)).has_widths);
  const TemporaryFolder folder;
  write_strands(folder.path() / "a.usda", random_strands(1), false);
  EXPECT_GT(read_strands(folder.path() / "a.usda").assumed_width, 0);
}

}  // namespace
}  // namespace pelage::usd_curves_test
