// SPDX-License-Identifier: Apache-2.0
#include "geom/curve.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/geom/random_strands.h"

namespace pelage {
namespace {

struct Point4 {
  double v[4];
};

Point4 lerp(const Point4& a, const Point4& b, double t) {
  Point4 r;
  for (int i = 0; i < 4; ++i) r.v[i] = (1 - t) * a.v[i] + t * b.v[i];
  return r;
}

/// de Boor's algorithm for a uniform cubic B-spline on knots 0, 1, 2 ...: x in [3, points].
Point4 de_boor(const std::vector<Point4>& points, double x) {
  const int k = std::min(static_cast<int>(x), static_cast<int>(points.size()) - 1);
  Point4 d[4];
  for (int j = 0; j < 4; ++j) d[j] = points[static_cast<size_t>(j + k - 3)];
  for (int r = 1; r <= 3; ++r) {
    for (int j = 3; j >= r; --j) d[j] = lerp(d[j - 1], d[j], (x - (j + k - 3)) / (4.0 - r));
  }
  return d[3];
}

/// Points of a strand with the phantom ends that `basis` asks for.
std::vector<Point4> control_points(const Strands& strands, size_t strand, int key) {
  std::vector<Point4> points;
  for (uint32_t i = 0; i < strands.strand_points(strand); ++i) {
    const size_t at = strands.first_point(strand) + i;
    const V3f p = strands.point(at, key);
    points.push_back({{p.x, p.y, p.z, strands.radius(at, key)}});
  }
  if (strands.basis() != CurveBasis::kBSpline) {
    points.insert(points.begin(), lerp(points[0], points[1], -1));
    points.push_back(lerp(points[points.size() - 1], points[points.size() - 2], -1));
  }
  return points;
}

void expect_near(const CubicSegment& s, float t, const Point4& truth, double tolerance) {
  const V3f p = curve_position(s, t);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(p[axis], truth.v[axis], tolerance);
  EXPECT_NEAR(curve_radius(s, t), std::max(truth.v[3], 0.0), tolerance);
}

class BSplines : public testing::TestWithParam<CurveBasis> {};
INSTANTIATE_TEST_SUITE_P(Curve, BSplines, testing::Values(CurveBasis::kPinnedBSpline, CurveBasis::kBSpline));

TEST_P(BSplines, AgreeWithDeBoor) {
  RandomStrandOptions options;
  options.basis = GetParam();
  options.min_points = options.basis == CurveBasis::kBSpline ? 4 : 2;
  const Strands strands = random_strands(1, options);
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    const std::vector<Point4> points = control_points(strands, s, 0);
    const uint32_t segments = segment_count(strands.basis(), strands.strand_points(s));
    ASSERT_EQ(segments + 3, points.size());
    for (uint32_t segment = 0; segment < segments; ++segment) {
      const CubicSegment bezier = bezier_segment(strands, s, segment);
      for (float t : {0.0f, 0.125f, 0.5f, 0.875f, 1.0f}) {
        expect_near(bezier, t, de_boor(points, 3.0 + segment + static_cast<double>(t)), 2e-6);
      }
    }
  }
}

TEST(Curve, PinnedEndsMeetTheFirstAndLastPointExactly) {
  for (CurveBasis basis : {CurveBasis::kPinnedBSpline, CurveBasis::kCatmullRom, CurveBasis::kLinear}) {
    RandomStrandOptions options;
    options.basis = basis;
    const Strands strands = random_strands(2, options);
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      const size_t first = strands.first_point(s);
      const size_t last = strands.first_point(s + 1) - 1;
      const uint32_t segments = segment_count(basis, strands.strand_points(s));
      const CubicSegment a = bezier_segment(strands, s, 0);
      const CubicSegment b = bezier_segment(strands, s, segments - 1);
      EXPECT_EQ(curve_position(a, 0), strands.point(first));
      EXPECT_EQ(curve_radius(a, 0), strands.radius(first));
      EXPECT_EQ(curve_position(b, 1), strands.point(last));
      EXPECT_EQ(curve_radius(b, 1), strands.radius(last));
    }
  }
}

TEST(Curve, CatmullRomMeetsEveryPointWithAContinuousTangent) {
  RandomStrandOptions options;
  options.basis = CurveBasis::kCatmullRom;
  options.min_points = 3;
  const Strands strands = random_strands(3, options);
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    for (uint32_t i = 0; i + 2 < strands.strand_points(s); ++i) {
      const CubicSegment a = bezier_segment(strands, s, i);
      const CubicSegment b = bezier_segment(strands, s, i + 1);
      EXPECT_EQ(curve_position(a, 1), strands.point(strands.first_point(s) + i + 1));
      EXPECT_EQ(curve_position(b, 0), strands.point(strands.first_point(s) + i + 1));
      EXPECT_LT((curve_tangent(a, 1) - curve_tangent(b, 0)).length(), 2e-6f);
    }
  }
}

TEST(Curve, SegmentsOfAStrandJoin) {
  const Strands strands = random_strands(4);
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    for (uint32_t i = 0; i + 2 < strands.strand_points(s); ++i) {
      const CubicSegment a = bezier_segment(strands, s, i);
      const CubicSegment b = bezier_segment(strands, s, i + 1);
      EXPECT_LT((a.p[3] - b.p[0]).length(), 5e-7f);
      EXPECT_LT((curve_tangent(a, 1) - curve_tangent(b, 0)).length(), 5e-6f);
    }
  }
}

TEST(Curve, TangentIsTheDerivative) {
  const Strands strands = random_strands(5);
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    const CubicSegment c = bezier_segment(strands, s, 0);
    const float h = 1.0f / 64;
    for (float t : {0.25f, 0.5f, 0.75f}) {
      // Richardson's extrapolation of central differences is exact for cubics.
      const V3f wide = (curve_position(c, t + 2 * h) - curve_position(c, t - 2 * h)) / (4 * h);
      const V3f narrow = (curve_position(c, t + h) - curve_position(c, t - h)) / (2 * h);
      EXPECT_LT(((4.0f * narrow - wide) / 3.0f - curve_tangent(c, t)).length(), 5e-5f);
    }
  }
}

TEST(Curve, TangentOfDegenerateEndsPointsAlongTheCurve) {
  const V3f o(1, 2, 3), x(2, 2, 3), y(3, 2, 3);
  const auto along_x = [](const V3f& v) { return v.x > 0 && v.y == 0 && v.z == 0; };
  EXPECT_TRUE(along_x(curve_tangent({{o, o, x, y}, {}}, 0)));
  EXPECT_TRUE(along_x(curve_tangent({{o, o, o, y}, {}}, 0)));
  EXPECT_TRUE(along_x(curve_tangent({{o, x, y, y}, {}}, 1)));
  EXPECT_TRUE(along_x(curve_tangent({{o, y, y, y}, {}}, 1)));
  EXPECT_TRUE(along_x(curve_tangent({{o, o, y, y}, {}}, 0.5f)));
  EXPECT_EQ(curve_tangent({{o, o, o, o}, {}}, 0.5f), V3f(0, 1, 0));
}

TEST(Curve, MovesLinearlyBetweenKeys) {
  RandomStrandOptions options;
  options.motion_keys = 3;
  const Strands strands = random_strands(6, options);
  const auto expect_same = [](const CubicSegment& a, const CubicSegment& b, float tolerance) {
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_LE((a.p[i] - b.p[i]).length(), tolerance);
      EXPECT_NEAR(a.r[i], b.r[i], tolerance);
    }
  };
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    for (int key = 0; key < 3; ++key) {
      const CubicSegment at = bezier_segment_at(strands, s, 0, 0.5f * static_cast<float>(key));
      expect_same(at, bezier_segment(strands, s, 0, key), 0);
    }
    const CubicSegment a = bezier_segment(strands, s, 0, 1), b = bezier_segment(strands, s, 0, 2);
    CubicSegment between;
    for (size_t i = 0; i < 4; ++i) {
      between.p[i] = 0.75f * a.p[i] + 0.25f * b.p[i];
      between.r[i] = 0.75f * a.r[i] + 0.25f * b.r[i];
    }
    expect_same(bezier_segment_at(strands, s, 0, 0.625f), between, 5e-7f);
  }
}

TEST(Curve, FindsTheSegmentOfAnAddressAlongTheStrand) {
  RandomStrandOptions options;
  options.min_points = options.max_points = 5;
  const Strands strands = random_strands(7, options);
  float t = -1;
  const CubicSegment first = segment_at(strands, 0, 0, 0, t);
  EXPECT_EQ(curve_position(first, t), strands.point(0));
  const CubicSegment last = segment_at(strands, 0, 1, 0, t);
  EXPECT_EQ(curve_position(last, t), strands.point(4));
  EXPECT_EQ(t, 1);
  const CubicSegment third = segment_at(strands, 1, 0.625f, 0, t);
  EXPECT_EQ(t, 0.5f);
  EXPECT_EQ(third.p[0], bezier_segment(strands, 1, 2).p[0]);
}

}  // namespace
}  // namespace pelage
