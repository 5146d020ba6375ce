// SPDX-License-Identifier: Apache-2.0
#include "geom/strand_point.h"

#include <gtest/gtest.h>

#include "geom/curve.h"
#include "tests/geom/random_strands.h"

namespace pelage {
namespace {

class StrandPointOfBasis : public testing::TestWithParam<CurveBasis> {};

TEST_P(StrandPointOfBasis, IsThatOfTheBezierSegment) {
  for (int keys : {1, 3}) {
    RandomStrandOptions o;
    o.basis = GetParam();
    o.motion_keys = keys;
    o.min_points = GetParam() == CurveBasis::kBSpline ? 4 : 2;
    const Strands strands = random_strands(41, o);
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      const uint32_t count = segment_count(strands.basis(), strands.strand_points(s));
      for (uint32_t segment = 0; segment < count; ++segment) {
        for (float t : {0.0f, 0.3f, 0.75f, 1.0f}) {
          const float time = unit_float(hash64(s, segment));
          const CubicSegment bezier = bezier_segment_at(strands, s, segment, time);
          const StrandPoint point = strand_point(strands, s, segment, t, time);
          EXPECT_LT((point.position - curve_position(bezier, t)).length(), 2e-6f);
          EXPECT_NEAR(point.radius, curve_radius(bezier, t), 1e-7f);
          const V3f tangent = curve_tangent(bezier, t).normalized();
          EXPECT_LT((point.tangent - tangent).length(), 1e-3f) << s << ' ' << segment << ' ' << t;
          EXPECT_NEAR(point.tangent.length(), 1, 1e-5f);
          if (t == 0.3f) {
            const float v = (static_cast<float>(segment) + t) / static_cast<float>(count);
            EXPECT_LT((strand_tangent(strands, s, v, time) - tangent).length(), 1e-3f);
          }
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bases, StrandPointOfBasis,
                         testing::Values(CurveBasis::kLinear, CurveBasis::kPinnedBSpline,
                                         CurveBasis::kBSpline, CurveBasis::kCatmullRom));

TEST(StrandPoint, HasATangentWhereTheCurveStandsStill) {
  StrandArrays a;
  a.points = {1, 1, 1, 0.1f, 1, 1, 1, 0.1f, 1, 1, 1, 0.1f, 1, 3, 1, 0.1f};
  a.first_point = {0, 4};
  a.ids = {0};
  const Strands strands(std::move(a));
  for (uint32_t segment = 0; segment < 3; ++segment) {
    EXPECT_NEAR(strand_point(strands, 0, segment, 0, 0).tangent.length(), 1, 1e-5f);
  }
  EXPECT_NEAR(strand_tangent(strands, 0, 0.5f, 0).y, 1, 1e-5f);
}

}  // namespace
}  // namespace pelage
