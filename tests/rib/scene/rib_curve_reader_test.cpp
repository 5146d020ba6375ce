// SPDX-License-Identifier: Apache-2.0
#include "rib/scene/rib_curve_reader.h"

#include <cmath>

#include <gtest/gtest.h>

#include "geom/curve.h"
#include "rib/syntax/rib_basis.h"
#include "rib/syntax/rib_curve_layout.h"
#include "tests/rib/syntax/rib_bytes_of.h"

namespace pelage::rib_curve_reader_test {
namespace {

using namespace rib_test;

RibBasis basis(const char* name, int step) {
  RibBasis basis = *RibBasis::named(name);
  basis.step = step;
  return basis;
}

RibCurveSet read(const std::string& text, const RibBasis& basis) {
  std::vector<RibStatement> all = statements_of(text);
  return read_curves(all, RibDeclarations(), basis);
}

std::string failure(const std::string& text, const RibBasis& basis) {
  return error_of([&] { read(text, basis); });
}

// Points of a curve that has no symmetry.
const std::string kEight = "[0 0 0  1 0.2 0  2 1 0.5  2.5 2 1  3 2.2 2  3.5 2 2.5  5 1 2  6 0 1]";
const float kEightPoints[] = {0, 0,    0, 1,    .2f, 0,    2, 1, .5f, 2.5f, 2, 1,
                              3, 2.2f, 2, 3.5f, 2,   2.5f, 5, 1, 2,   6,    0, 1};

// The position by the definition of the basis, in double precision.
Imath::V3d defined(const RibBasis& basis, const float* p, size_t count, uint32_t segment, double t) {
  Imath::V3d sum(0);
  const double powers[] = {t * t * t, t * t, t, 1};
  for (size_t j = 0; j < 4; ++j) {
    double weight = 0;
    for (size_t i = 0; i < 4; ++i) weight += powers[i] * basis.matrix[static_cast<int>(i)][j];
    const float* q = p + 3 * ((segment * static_cast<size_t>(basis.step) + j) % count);
    sum += weight * Imath::V3d(q[0], q[1], q[2]);
  }
  return sum;
}

// Max distance between a strand and the curve that its request defines, at equal parameters.
double distance(const Strands& strands, size_t strand, const RibBasis& basis, const float* p, size_t count,
                uint32_t first, uint32_t segments) {
  double worst = 0;
  const uint32_t own = segment_count(strands.basis(), strands.strand_points(strand));
  for (uint32_t s = 0; s < segments; ++s) {
    for (double t = 0; t <= 1; t += 1.0 / 32) {
      const double at = (s + t) * own / segments;
      const auto piece = std::min(static_cast<uint32_t>(at), own - 1);
      const V3f is = curve_position(bezier_segment(strands, strand, piece), static_cast<float>(at - piece));
      worst = std::max(worst, (Imath::V3d(is) - defined(basis, p, count, first + s, t)).length());
    }
  }
  return worst;
}

TEST(RibCurveReader, TakesSplinesAsTheyAre) {
  const auto spline = basis("b-spline", 1);
  const RibCurveSet set =
      read("Curves \"cubic\" [8] \"nonperiodic\" \"P\" " + kEight + " \"constantwidth\" 0.5", spline);
  const Strands strands(set.strands);
  EXPECT_EQ(strands.basis(), CurveBasis::kBSpline);
  EXPECT_EQ(strands.strand_points(0), 8u);
  EXPECT_FLOAT_EQ(strands.radius(3), 0.25f);
  EXPECT_LT(distance(strands, 0, spline, kEightPoints, 8, 0, 5), 1e-5);
}

// Splines are kept, so only single precision rounds them. Other curves are interpolated with a distance h =
// 1/4 of knots. This is exact for a cubic. Where the second derivative jumps by d, the error of the
// interpolating spline is below d h^2 / 32. The curves here have jumps of 1.81, 8.27, 36.8 and 81.
TEST(RibCurveReader, EveryBasisKeepsItsShape) {
  struct Case {
    const char* name;
    int step;
    bool periodic;
    uint32_t segments;
    double tolerance;
  };
  for (const Case& c :
       {Case{"b-spline", 1, false, 5, 1e-5}, Case{"b-spline", 1, true, 8, 1e-5},
        Case{"catmull-rom", 1, false, 5, 1.81 / 512}, Case{"catmull-rom", 1, true, 8, 8.27 / 512},
        Case{"hermite", 2, false, 3, 36.8 / 512}, Case{"hermite", 2, true, 4, 81.0 / 512}}) {
    const RibBasis b = basis(c.name, c.step);
    const RibCurveSet set = read(std::string("Curves \"cubic\" [8] \"") +
                                     (c.periodic ? "periodic" : "nonperiodic") + "\" \"P\" " + kEight,
                                 b);
    const Strands strands(set.strands);
    ASSERT_EQ(strands.strand_count(), 1u) << c.name;
    EXPECT_LT(distance(strands, 0, b, kEightPoints, 8, 0, c.segments), c.tolerance) << c.name << c.periodic;
    EXPECT_FALSE(set.has_width);
    EXPECT_EQ(strands.radius(0), 0.5f) << "the width is 1";
  }
}

TEST(RibCurveReader, ASingleCubicIsExact) {
  for (const char* name : {"bezier", "catmull-rom", "hermite", "power"}) {
    const RibBasis b = basis(name, 3);
    const RibCurveSet set = read("Curves \"cubic\" [4] \"nonperiodic\" \"P\" [0 0 0 1 2 0 2 -1 1 3 0 1]", b);
    const float p[] = {0, 0, 0, 1, 2, 0, 2, -1, 1, 3, 0, 1};
    EXPECT_LT(distance(Strands(set.strands), 0, b, p, 4, 0, 1), 2e-5) << name;
  }
}

TEST(RibCurveReader, SegmentsThatDoNotMeetAreStrandsOfTheirOwn) {
  const RibBasis b = basis("bezier", 4);
  const RibCurveSet set =
      read("Curves \"cubic\" [8] \"nonperiodic\" \"P\" " + kEight + " \"uniform integer id\" [7]", b);
  const Strands strands(set.strands);
  ASSERT_EQ(strands.strand_count(), 2u);
  EXPECT_FALSE(set.has_ids);
  EXPECT_NE(strands.id(0), strands.id(1));
  for (size_t s = 0; s < 2; ++s)
    EXPECT_LT(distance(strands, s, b, kEightPoints, 8, static_cast<uint32_t>(s), 1), 2e-5);
}

TEST(RibCurveReader, PhantomPointsGiveThePinnedStrandBitForBit) {
  // 2 P0 - P1 and 2 P3 - P2.
  const std::string text =
      "Curves \"cubic\" [6] \"nonperiodic\" \"P\" [-1 -2 -4  0 0 0  1 2 4  2 2 5  4 2 5  6 2 5] "
      "\"varying float width\" [0.4 0.3 0.2 0.1]";
  const RibCurveSet set = read(text, basis("b-spline", 1));
  const Strands strands(set.strands);
  EXPECT_EQ(strands.basis(), CurveBasis::kPinnedBSpline);
  ASSERT_EQ(strands.strand_points(0), 4u);
  EXPECT_EQ(strands.point(0), V3f(0));
  EXPECT_EQ(strands.point(3), V3f(4, 2, 5));
  EXPECT_EQ(strands.radius(1), 0.5f * 0.3f);
  EXPECT_EQ(Strands(read(text, basis("catmull-rom", 1)).strands).basis(), CurveBasis::kCatmullRom);
}

TEST(RibCurveReader, LinearCurvesAndTheirPeriod) {
  const Strands open(
      read("Curves \"linear\" [2 3] \"nonperiodic\" \"P\" [0 0 0 1 0 0 0 0 0 1 0 0 2 1 0]", {}).strands);
  EXPECT_EQ(open.basis(), CurveBasis::kLinear);
  EXPECT_EQ(open.strand_points(1), 3u);
  const Strands loop(
      read("Curves \"linear\" [3] \"periodic\" \"P\" [0 0 0 1 0 0 2 1 0] \"varying float width\" [1 2 3]", {})
          .strands);
  ASSERT_EQ(loop.strand_points(0), 4u);
  EXPECT_EQ(loop.point(3), loop.point(0));
  EXPECT_EQ(loop.radius(3), loop.radius(0));
}

TEST(RibCurveReader, ParametersOfEveryClass) {
  const RibCurveSet set = read(
      "Curves \"linear\" [2 3] \"nonperiodic\" \"P\" [0 0 0 1 0 0 0 0 0 1 0 0 2 1 0] \"uniform color Cs\" [1 "
      "0 0 0 1 0] "
      "\"constant float a\" 7 \"varying float b\" [1 2 3 4 5] \"vertex float c\" [6 7 8 9 10] "
      "\"uniform float[2] st\" [.1 .2 .3 .4] \"uniform integer id\" [9 -1] \"uniform integer id_high\" [0 2] "
      "\"uniform string what\" [\"x\" \"y\"] \"rust\" 5",
      {});
  const StrandArrays& a = set.strands;
  const Strands strands(a);
  EXPECT_TRUE(set.has_color);
  EXPECT_EQ(strands.find_attribute("color")->frequency, AttributeClass::kPerStrand);
  EXPECT_EQ(strands.find_attribute("color")->values, (std::vector<float>{1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(strands.find_attribute("a")->values, (std::vector<float>{7}));
  EXPECT_EQ(strands.find_attribute("b")->values, (std::vector<float>{1, 2, 3, 4, 5}));
  EXPECT_EQ(strands.find_attribute("c")->values, (std::vector<float>{6, 7, 8, 9, 10}));
  EXPECT_EQ(a.root_uv, (std::vector<V2f>{V2f(.1f, .2f), V2f(.3f, .4f)}));
  EXPECT_EQ(a.ids, (std::vector<uint64_t>{9, (uint64_t(2) << 32) | 0xffffffffu}));
  EXPECT_EQ(set.unsupported, (std::vector<std::string>{"what"}));
  EXPECT_EQ(set.undeclared, (std::vector<std::string>{"rust"}));
}

TEST(RibCurveReader, CurvesWithTooFewPointsGiveNoStrands) {
  const RibCurveSet lines = read(
      "Curves \"linear\" [1 2 0 3] \"nonperiodic\" \"P\" [9 9 9 0 0 0 1 0 0 0 0 1 1 0 1 2 0 1] "
      "\"varying float width\" [9 1 2 3 4 5] \"uniform color Cs\" [9 9 9 1 0 0 9 9 9 0 1 0] "
      "\"uniform integer id\" [9 5 9 6]",
      {});
  EXPECT_EQ(lines.unusable, 2u);
  const Strands strands(lines.strands);
  ASSERT_EQ(strands.strand_count(), 2u);
  EXPECT_EQ(strands.point(0), V3f(0));
  EXPECT_EQ(strands.radius(0), .5f);
  EXPECT_EQ(strands.radius(4), 2.5f);
  EXPECT_EQ(strands.find_attribute("color")->values, (std::vector<float>{1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(strands.id(1), 6u);
  // Programs disagree about the number of joints of a curve that is too short.
  for (const char* widths : {"[1 2]", "[9 1 2]", "[9 9 1 2]"}) {
    for (const char* basis_name : {"bezier", "b-spline"}) {
      const RibCurveSet cubic =
          read(std::string("Curves \"cubic\" [3 4] \"nonperiodic\" \"P\" [9 9 9 9 9 9 9 9 9 "
                           "0 0 0 1 0 0 2 0 0 3 0 0] \"varying float width\" ") +
                   widths,
               basis(basis_name, 1));
      EXPECT_EQ(cubic.unusable, 1u);
      ASSERT_EQ(cubic.strands.ids.size(), 1u);
      EXPECT_LT(cubic.strands.points[4], 3) << "not of the short curve";
      EXPECT_LT(cubic.strands.points[7], 2) << "not of the short curve";
    }
  }
  EXPECT_TRUE(
      read("Curves \"cubic\" [5] \"nonperiodic\" \"P\" [0 0 0 1 0 0 2 0 0 3 0 0 4 0 0]", basis("bezier", 3))
          .strands.ids.empty());
}

TEST(RibCurveReader, PinnedCurvesReachTheirEnds) {
  const std::string pinned = "Curves \"cubic\" [4] \"pinned\" \"P\" [0 0 0 1 2 4 2 2 5 4 2 5] ";
  for (const char* name : {"b-spline", "catmull-rom"}) {
    const RibCurveSet set = read(pinned + "\"varying float width\" [4 3 2 1]", basis(name, 1));
    const RibCurveSet phantoms = read(
        "Curves \"cubic\" [6] \"nonperiodic\" \"P\" [-1 -2 -4 0 0 0 1 2 4 2 2 5 4 2 5 6 2 5] \"varying float "
        "width\" [4 3 2 1]",
        basis(name, 1));
    EXPECT_EQ(set.strands.points, phantoms.strands.points) << name;
    EXPECT_EQ(set.strands.basis, phantoms.strands.basis) << name;
  }
  EXPECT_EQ(read(pinned, basis("b-spline", 1)).unusable + read(pinned, basis("bezier", 3)).unusable, 0u);
}

TEST(RibCurveReader, ClassesAreCorrectedByCount) {
  const RibCurveSet set = read(
      "Curves \"cubic\" [5] \"nonperiodic\" \"P\" [0 0 0 1 0 0 2 1 0 3 1 0 4 0 1] \"varying float width\" [5 "
      "4 3 2 1] "
      "\"varying color Cs\" [1 0 0 1]",
      basis("b-spline", 1));
  EXPECT_FLOAT_EQ(set.strands.points[3], 2.5f) << "per point";
  EXPECT_FALSE(set.has_color);
  EXPECT_EQ(set.misfits,
            (std::vector<std::string>{"parameter 'Cs' needs 9 numbers for these curves, got 4"}));
}

TEST(RibCurveReader, OpacityIsTheMeanOfOs) {
  const RibCurveSet set = read(
      "Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 0 1 0 0] \"varying color Os\" [1 1 1 0 .3 .6] "
      "\"constantwidth\" -1 \"varying normal N\" [1 0 0 1 0 0]",
      {});
  EXPECT_TRUE(set.has_opacity);
  EXPECT_TRUE(set.negative_widths);
  EXPECT_TRUE(set.ribbons);
  const StrandAttribute& opacity = set.strands.attributes.at(0);
  EXPECT_EQ(opacity.name, "opacity");
  EXPECT_FLOAT_EQ(opacity.values.at(1), .3f);
}

TEST(RibCurveReader, WidthsOfOpenSplinesContinueBeyondTheJoints) {
  const Strands strands(read("Curves \"cubic\" [5] \"nonperiodic\" \"P\" [0 0 0 1 0 0 2 1 0 3 1 0 4 0 1] "
                             "\"varying float width\" [3 2 1]",
                             basis("b-spline", 1))
                            .strands);
  const float radii[] = {2, 1.5f, 1, .5f, 0};
  for (size_t i = 0; i < 5; ++i) EXPECT_FLOAT_EQ(strands.radius(i), radii[i]);
}

TEST(RibCurveReader, MotionHasAKeyPerSample) {
  std::vector<RibStatement> all = statements_of(
      "Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 0 1 0 0] \"constantwidth\" 1\n"
      "Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 1 1 0 1]");
  const Strands strands(read_curves(all, RibDeclarations(), {}).strands);
  EXPECT_EQ(strands.motion_keys(), 2);
  EXPECT_EQ(strands.point(1, 1), V3f(1, 0, 1));
  EXPECT_EQ(strands.radius(1, 1), 0.5f);
  all = statements_of(
      "Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 0 1 0 0]\n"
      "Curves \"linear\" [3] \"nonperiodic\" \"P\" [0 0 1 1 0 1 2 0 1]");
  EXPECT_NE(error_of([&] { read_curves(all, RibDeclarations(), {}); }).find("same numbers of points"),
            std::string::npos);
}

TEST(RibCurveReader, WrongCountsAreErrorsWithPositions) {
  const RibBasis bezier = basis("bezier", 3);
  EXPECT_EQ(failure("Curves \"linear\" [3] \"nonperiodic\" \"P\" [0 0 0]", bezier),
            "a.rib:1:39: Curves: parameter 'P' needs 9 numbers for these curves, got 3");
  EXPECT_EQ(
      failure("Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 0 1 0 0] \"varying float width\" [1 2 3]",
              bezier),
      "a.rib:1:75: Curves: parameter 'width' needs 2 numbers for these curves, got 3");
  EXPECT_EQ(failure("Curves \"linear\" [1000000000 1000000000] \"nonperiodic\" \"P\" [0 0 0]", bezier),
            "a.rib:1:17: Curves: a curve has 1000000000 points");
  EXPECT_EQ(failure("Curves \"linear\" [-1] \"nonperiodic\"", bezier),
            "a.rib:1:17: Curves: a curve has -1 points");
  EXPECT_EQ(failure("Curves \"quadratic\" [3] \"nonperiodic\"", bezier),
            "a.rib:1:8: Curves: unknown type 'quadratic'; expected \"linear\" or \"cubic\"");
  EXPECT_EQ(failure("Curves \"linear\" [2] \"nonperiodic\"", bezier),
            "a.rib:1:1: Curves: parameter \"P\" is missing");
  EXPECT_NE(failure("Curves \"linear\" 2", bezier).find("expected a type"), std::string::npos);
}

}  // namespace
}  // namespace pelage::rib_curve_reader_test
