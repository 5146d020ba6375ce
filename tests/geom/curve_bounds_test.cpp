// SPDX-License-Identifier: Apache-2.0
#include "geom/curve_bounds.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "tests/geom/random_strands.h"

namespace pelage {
namespace {

constexpr int kSteps = 128;

/// Box of densely sampled points +- radius: the slow truth, from inside.
void extend_by_samples(Box3f& box, const CubicSegment& s) {
  for (int i = 0; i <= kSteps; ++i) {
    const float t = static_cast<float>(i) / kSteps;
    const V3f reach(curve_radius(s, t));
    box.extendBy(curve_position(s, t) - reach);
    box.extendBy(curve_position(s, t) + reach);
  }
}

void expect_contains(const Box3f& outer, const Box3f& inner) {
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(outer.min[axis], inner.min[axis]);
    EXPECT_GE(outer.max[axis], inner.max[axis]);
  }
}

/// Each face of `outer` is touched by `inner` up to 1e-4 of the box's size, or to what floats resolve at
/// `distance` from the origin: the 2^-21 that boxes are enlarged by, and as much for the samples themselves.
void expect_touches(const Box3f& outer, const Box3f& inner, float distance) {
  const float gap = std::max(1e-4f * outer.size().length(), 0x1p-20f * (1.0f + distance));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(inner.min[axis] - outer.min[axis], gap);
    EXPECT_LE(outer.max[axis] - inner.max[axis], gap);
  }
}

float surface_area(const Box3f& box) {
  const V3f d = box.size();
  return 2 * (d.x * d.y + d.y * d.z + d.z * d.x);
}

template <class Function>
void for_each_segment(const Strands& strands, Function function) {
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    const uint32_t segments = segment_count(strands.basis(), strands.strand_points(s));
    for (uint32_t i = 0; i < segments; ++i) function(s, i);
  }
}

struct Case {
  const char* name;
  RandomStrandOptions options;
};

class Bounds : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(
    Curve, Bounds,
    testing::Values(Case{"thin", {.radius = 0.001f}}, Case{"thick", {.radius = 0.3f}},
                    Case{"straight", {.wander = 0}}, Case{"far", {.centre = V3f(1000, -2000, 500)}},
                    Case{"catmull_rom", {.radius = 0.2f, .basis = CurveBasis::kCatmullRom}},
                    Case{"linear", {.basis = CurveBasis::kLinear}},
                    Case{"unpinned", {.min_points = 4, .basis = CurveBasis::kBSpline}},
                    Case{"tiny", {.step = 1e-6f, .radius = 1e-7f}}, Case{"no_width", {.radius = 0}}),
    [](const auto& test) { return std::string(test.param.name); });

TEST_P(Bounds, OfASegmentContainAndTouch) {
  const Strands strands = random_strands(11, GetParam().options);
  for_each_segment(strands, [&](size_t s, uint32_t i) {
    const CubicSegment segment = bezier_segment(strands, s, i);
    Box3f samples;
    extend_by_samples(samples, segment);
    const Box3f exact = exact_bounds(segment);
    expect_contains(exact, samples);
    expect_contains(hull_bounds(segment), exact);
    expect_touches(exact, samples, GetParam().options.centre.length());
  });
}

TEST_P(Bounds, OfAllSegmentsOfAStrandAreThoseOfEach) {
  RandomStrandOptions options = GetParam().options;
  options.motion_keys = 2;
  const Strands strands = random_strands(13, options);
  for (int key : {0, 1}) {
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      std::vector<Box3f> boxes;
      append_hull_bounds(strands, s, key, boxes);
      ASSERT_EQ(boxes.size(), segment_count(strands.basis(), strands.strand_points(s)));
      for (uint32_t i = 0; i < boxes.size(); ++i) {
        const CubicSegment segment = bezier_segment(strands, s, i, key);
        expect_contains(boxes[i], exact_bounds(segment));
        const Box3f one = hull_bounds(segment);
        const float gap = 0x1p-20f * std::max(one.max.length(), one.min.length());
        expect_contains({one.min - V3f(gap), one.max + V3f(gap)}, boxes[i]);
      }
    }
  }
}

TEST_P(Bounds, OfABatchContainAndTouch) {
  RandomStrandOptions options = GetParam().options;
  for (int keys : {1, 2, 4}) {
    options.motion_keys = keys;
    const Strands strands = random_strands(12 + static_cast<uint64_t>(keys), options);
    for (const auto& [open, close] : {std::pair(0.0f, 1.0f), {0.2f, 0.9f}, {0.4f, 0.45f}, {1.0f, 1.0f}}) {
      const Box3f exact = exact_bounds(strands, open, close);
      Box3f samples;
      for (int step = 0; step <= 10; ++step) {
        const float time = open + (close - open) * static_cast<float>(step) / 10;
        for_each_segment(strands, [&](size_t s, uint32_t i) {
          extend_by_samples(samples, bezier_segment_at(strands, s, i, time));
        });
      }
      // Samples in time miss the keys; where those are extreme the samples get one more chance.
      for (int key = 0; key < keys; ++key) {
        const float time = keys < 2 ? 0 : static_cast<float>(key) / static_cast<float>(keys - 1);
        if (time < open || time > close) continue;
        for_each_segment(strands, [&](size_t s, uint32_t i) {
          extend_by_samples(samples, bezier_segment_at(strands, s, i, time));
        });
      }
      expect_contains(exact, samples);
      expect_touches(exact, samples, options.centre.length());
    }
  }
}

TEST(Bounds, AHalfShutterIsSmallerThanAWholeOne) {
  StrandArrays a;
  a.motion_keys = 2;
  a.first_point = {0, 2};
  a.ids = {0};
  a.points = {0, 0, 0, 0, 0, 1, 0, 0, 4, 0, 0, 0, 4, 1, 0, 0};
  const Strands strands(std::move(a));
  EXPECT_NEAR(exact_bounds(strands, 0, 1).max.x, 4, 1e-5);
  EXPECT_NEAR(exact_bounds(strands, 0.25f, 0.75f).min.x, 1, 1e-5);
  EXPECT_NEAR(exact_bounds(strands, 0.25f, 0.75f).max.x, 3, 1e-5);
  EXPECT_NEAR(exact_bounds(strands, 0.5f, 0.5f).size().x, 0, 1e-5);
}

TEST(Bounds, AnEmptyBatchHasAnEmptyBox) { EXPECT_TRUE(exact_bounds(Strands()).isEmpty()); }

TEST(Bounds, WidthCountsWhereTheCurveDoes) {
  // A parabola whose top is at t = 1/2, fat only at its lower ends: position +- largest radius would be 1 too
  // high.
  const CubicSegment arch{{V3f(0, 0, 0), V3f(1, 4, 0), V3f(2, 4, 0), V3f(3, 0, 0)}, {1, -1, -1, 1}};
  // radius (1 - 2t)^2 (...) reaches below 0 near the middle, where it counts as none: the top is the curve's
  // own, 3.
  EXPECT_NEAR(exact_bounds(arch).max.y, 3, 1e-5);
  EXPECT_NEAR(exact_bounds(arch).min.y, -1, 1e-5);
  EXPECT_NEAR(exact_bounds(arch).min.x, -1, 1e-5);
}

TEST(Bounds, BezierHullOfFurIsNearlyExactWhereControlPointsAreNot) {
  RandomStrandOptions options;
  options.strands = 2000;
  options.min_points = options.max_points = 8;
  options.wander = 0.15f;
  options.radius = 0.002f;
  const Strands strands = random_strands(13, options);
  double exact = 0, hull = 0, control = 0;
  for_each_segment(strands, [&](size_t s, uint32_t i) {
    const CubicSegment segment = bezier_segment(strands, s, i);
    exact += surface_area(exact_bounds(segment));
    hull += surface_area(hull_bounds(segment));
    Box3f box;
    const size_t base = strands.first_point(s);
    const auto at = [&](int j) {
      if (j < 0) return 2.0f * strands.point(base) - strands.point(base + 1);
      if (j > 7) return 2.0f * strands.point(base + 7) - strands.point(base + 6);
      return strands.point(base + static_cast<size_t>(j));
    };
    for (int j = -1; j <= 2; ++j) {
      box.extendBy(at(static_cast<int>(i) + j) - V3f(options.radius));
      box.extendBy(at(static_cast<int>(i) + j) + V3f(options.radius));
    }
    control += surface_area(box);
  });
  RecordProperty("hull_over_exact", std::to_string(hull / exact));
  RecordProperty("control_over_exact", std::to_string(control / exact));
  EXPECT_LT(hull / exact, 1.03);
  EXPECT_GT(control / exact, 6);
}

}  // namespace
}  // namespace pelage
