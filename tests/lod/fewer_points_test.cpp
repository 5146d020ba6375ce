// SPDX-License-Identifier: Apache-2.0
#include "lod/fewer_points.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "geom/curve.h"
#include "lod/point_fit.h"

namespace pelage {
namespace {

/// Bent strands with some wave, two motion keys, a colour per point and one number per strand.
Strands some_strands(size_t count, uint32_t points, float wave) {
  StrandArrays a;
  a.motion_keys = 2;
  a.first_point = {0};
  a.attributes = {{"color", AttributeClass::kPerPoint, 3, {}}, {"clump", AttributeClass::kPerStrand, 1, {}}};
  for (size_t s = 0; s < count; ++s) {
    a.ids.push_back(s);
    a.roots.push_back({static_cast<uint32_t>(s), 0.5f, 0.25f});
    a.root_uv.emplace_back(0.1f, 0.2f);
    a.attributes[1].values.push_back(static_cast<float>(s));
    a.first_point.push_back(a.first_point.back() + points);
    for (uint32_t p = 0; p < points; ++p) {
      const float v = static_cast<float>(p) / static_cast<float>(points - 1);
      for (const float c : {0.2f, 0.5f, 0.9f})
        a.attributes[0].values.push_back(c * (0.6f + 0.4f * std::sin(6 * v + static_cast<float>(s))));
    }
  }
  for (int key = 0; key < 2; ++key) {
    for (size_t s = 0; s < count; ++s) {
      const float bend = signed_float(hash64(s, random_use("bend"))) + 0.2f * static_cast<float>(key);
      for (uint32_t p = 0; p < points; ++p) {
        const float v = static_cast<float>(p) / static_cast<float>(points - 1);
        const V3f at(bend * v * v + wave * std::sin(9 * v + static_cast<float>(s)), 2 * v, 0.3f * v * v * v);
        a.points.insert(a.points.end(), {at.x, at.y, at.z, 0.02f * (1.1f - v)});
      }
    }
  }
  return Strands(std::move(a));
}

V3f at(const Strands& strands, size_t strand, float v, float time) {
  float t = 0;
  const CubicSegment segment = segment_at(strands, strand, v, time, t);
  return curve_position(segment, t);
}

float farthest_apart(const Strands& a, const Strands& b, size_t strand) {
  float max = 0;
  for (const float time : {0.0f, 1.0f}) {
    for (int i = 0; i <= 50; ++i) {
      const float v = static_cast<float>(i) / 50;
      max = std::max(max, (at(a, strand, v, time) - at(b, strand, v, time)).length());
    }
  }
  return max;
}

class FewerPointsOf : public testing::TestWithParam<uint32_t> {};

TEST_P(FewerPointsOf, CurvesStayWithinTheTolerance) {
  const Strands full = some_strands(300, GetParam(), 0.01f);
  for (const float tolerance : {0.001f, 0.01f, 0.03f, 0.2f}) {
    const std::vector<float> each(300, tolerance);
    const Strands fewer = with_fewer_points(Strands(full), each);
    ASSERT_EQ(fewer.strand_count(), 300u);
    for (size_t s = 0; s < 300; ++s) EXPECT_LE(farthest_apart(full, fewer, s), tolerance * 1.02f);
    if (tolerance > 0.1f) {
      EXPECT_EQ(fewer.point_count(), 300u * 4);
    } else if (tolerance < 0.002f) {
      EXPECT_GT(fewer.point_count(), 300u * (GetParam() - 1));
    }
  }
}

// The largest whose error is one matrix, the smallest of which two curves are compared, and many.
INSTANTIATE_TEST_SUITE_P(Points, FewerPointsOf, testing::Values(8, 64, 65, 300));

TEST(PointFit, HoldsWhatGrowsWithTheNumberOfPoints) {
  EXPECT_LT(PointFit(4096, 5).bytes(), 4096u * 64);
  EXPECT_LT(PointFit(64, 5).bytes(), 64u * 2048);
}

TEST(FewerPoints, EndsAndEverythingPerStrandStay) {
  const Strands full = some_strands(20, 8, 0);
  const Strands fewer = with_fewer_points(Strands(full), std::vector<float>(20, 0.1f));
  ASSERT_LT(fewer.point_count(), full.point_count());
  for (size_t s = 0; s < 20; ++s) {
    for (int key = 0; key < 2; ++key) {
      EXPECT_EQ(fewer.point(fewer.first_point(s), key), full.point(full.first_point(s), key));
      EXPECT_EQ(fewer.point(fewer.first_point(s + 1) - 1, key), full.point(full.first_point(s + 1) - 1, key));
    }
    EXPECT_EQ(fewer.id(s), full.id(s));
    EXPECT_EQ(fewer.root(s).face, full.root(s).face);
  }
  EXPECT_EQ(fewer.find_attribute("clump")->values, full.find_attribute("clump")->values);
}

TEST(FewerPoints, MeansOfRadiiAndColorsStay) {
  const Strands full = some_strands(50, 8, 0);
  const Strands fewer = with_fewer_points(Strands(full), std::vector<float>(50, 1.0f));
  const auto mean_color = [](const Strands& strands, size_t s) {
    const StrandAttribute& color = *strands.find_attribute("color");
    double sum = 0;
    for (int i = 0; i < 1000; ++i) {
      const float v =
          (static_cast<float>(i) + 0.5f) / 1000 * static_cast<float>(strands.strand_points(s) - 1);
      float value[3];
      interpolate_attribute(strands, color, s, static_cast<uint32_t>(v), v - std::floor(v), value);
      sum += value[1];
    }
    return sum / 1000;
  };
  const auto mean_radius = [](const Strands& strands, size_t s) {
    double sum = 0;
    for (int i = 0; i < 1000; ++i) {
      float t = 0;
      const CubicSegment segment = segment_at(strands, s, (static_cast<float>(i) + 0.5f) / 1000, 0, t);
      sum += curve_radius(segment, t);
    }
    return sum / 1000;
  };
  for (size_t s = 0; s < 50; ++s) {
    EXPECT_NEAR(mean_color(fewer, s), mean_color(full, s), 0.003);
    EXPECT_NEAR(mean_radius(fewer, s), mean_radius(full, s), 1e-5);
  }
}

// A bright band between dark ends, as guard hairs have: what is fitted overshoots it.
TEST(FewerPoints, BandsKeepTheirHue) {
  StrandArrays banded = some_strands(6, 8, 0).arrays();
  const float color[] = {0.68f, 0.47f, 0.29f}, dark = 0.15f;
  for (size_t i = 0; i < banded.attributes[0].values.size(); ++i) {
    const size_t point = i / 3 % 8, strand = i / 24;
    banded.attributes[0].values[i] = color[i % 3] * (point == 2 + strand % 3 || point == 4 ? 1 : dark);
  }
  const Strands full(std::move(banded));
  const Strands fewer = with_fewer_points(Strands(full), std::vector<float>(6, 1.0f));
  ASSERT_EQ(fewer.point_count(), 24u);
  const auto mean = [](const Strands& strands, size_t s, size_t c) {
    const std::vector<float>& values = strands.find_attribute("color")->values;
    const uint32_t first = strands.first_point(s), last = strands.first_point(s + 1) - 1;
    double sum = 0;
    for (uint32_t p = first; p <= last; ++p) sum += (p == first || p == last ? 0.5 : 1) * values[3 * p + c];
    return sum / (last - first);
  };
  for (size_t s = 0; s < 6; ++s) {
    for (size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(mean(fewer, s, c), mean(full, s, c), 0.004 * color[c]);
      for (uint32_t p = fewer.first_point(s); p < fewer.first_point(s + 1); ++p) {
        const float value = fewer.find_attribute("color")->values[3 * p + c];
        EXPECT_LE(value, color[c]);
        EXPECT_GE(value, dark * color[c]);
        EXPECT_NEAR(value / color[c], fewer.find_attribute("color")->values[3 * p] / color[0], 1e-5);
      }
    }
  }
}

TEST(FewerPoints, KeptFitsGiveTheSameStrands) {
  FewerPoints fewer;
  const std::vector<float> tolerance(30, 0.02f);
  for (const uint32_t points : {8u, 6u, 65u, 8u, 6u}) {
    const Strands full = some_strands(30, points, 0.01f);
    const Strands kept = fewer.refit(Strands(full), tolerance);
    const Strands fresh = with_fewer_points(Strands(full), tolerance);
    EXPECT_EQ(kept.arrays().first_point, fresh.arrays().first_point);
    EXPECT_EQ(kept.arrays().points, fresh.arrays().points);
    EXPECT_EQ(kept.find_attribute("color")->values, fresh.find_attribute("color")->values);
  }
}

TEST(FewerPoints, EachStrandByItself) {
  const Strands full = some_strands(10, 8, 0.02f);
  std::vector<float> tolerance(10, 0.0f);
  tolerance[4] = 1;
  const Strands fewer = with_fewer_points(Strands(full), tolerance);
  const Strands all = with_fewer_points(Strands(full), std::vector<float>(10, 1.0f));
  for (size_t s = 0; s < 10; ++s) EXPECT_EQ(fewer.strand_points(s), s == 4 ? 4u : 8u);
  for (uint32_t p = 0; p < 4; ++p)
    EXPECT_EQ(fewer.point(fewer.first_point(4) + p, 1), all.point(all.first_point(4) + p, 1));
  for (uint32_t p = 0; p < 8; ++p)
    EXPECT_EQ(fewer.point(fewer.first_point(9) + p, 1), full.point(full.first_point(9) + p, 1));
}

TEST(FewerPoints, ShortStrandsAndOtherBasesStay) {
  const Strands four = some_strands(3, 4, 0.1f);
  EXPECT_EQ(with_fewer_points(Strands(four), std::vector<float>(3, 9.0f)).point_count(), 12u);
  StrandArrays linear = some_strands(3, 8, 0).arrays();
  linear.basis = CurveBasis::kLinear;
  EXPECT_EQ(with_fewer_points(Strands(linear), std::vector<float>(3, 9.0f)).point_count(), 24u);
}

}  // namespace
}  // namespace pelage
