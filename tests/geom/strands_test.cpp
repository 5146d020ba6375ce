// SPDX-License-Identifier: Apache-2.0
#include "geom/strands.h"

#include <functional>

#include <gtest/gtest.h>

#include "base/error.h"

namespace pelage::strands_test {
namespace {

StrandArrays two_strands(CurveBasis basis = CurveBasis::kPinnedBSpline) {
  StrandArrays a;
  a.basis = basis;
  a.first_point = {0, 4, 9};
  for (int i = 0; i < 9; ++i) a.points.insert(a.points.end(), {float(i), 0, 0, 0.5f});
  a.ids = {7, 9};
  a.attributes.push_back({"hue", AttributeClass::kConstant, 1, {3}});
  a.attributes.push_back({"tint", AttributeClass::kPerStrand, 2, {1, 2, 3, 4}});
  a.attributes.push_back({"age", AttributeClass::kPerPoint, 1, {0, 1, 4, 9, 16, 25, 36, 49, 64}});
  return a;
}

TEST(Strands, KnowsItsCounts) {
  const Strands strands(two_strands());
  EXPECT_EQ(strands.strand_count(), 2u);
  EXPECT_EQ(strands.point_count(), 9u);
  EXPECT_EQ(strands.strand_points(1), 5u);
  EXPECT_EQ(strands.id(1), 9u);
  EXPECT_EQ(strands.point(5), V3f(5, 0, 0));
  EXPECT_EQ(strands.radius(5), 0.5f);
  EXPECT_FALSE(strands.has_roots());
  EXPECT_NE(strands.find_attribute("tint"), nullptr);
  EXPECT_EQ(strands.find_attribute("tin"), nullptr);
  EXPECT_GE(strands.bytes(), 9u * 16 + 3 * 4 + 2 * 8 + (1 + 4 + 9) * 4);
  EXPECT_EQ(Strands().strand_count(), 0u);
  EXPECT_EQ(Strands().point_count(), 0u);
}

TEST(Strands, SegmentsByBasis) {
  for (CurveBasis basis : {CurveBasis::kLinear, CurveBasis::kPinnedBSpline, CurveBasis::kCatmullRom}) {
    EXPECT_EQ(segment_count(basis, 8), 7u);
    EXPECT_EQ(segment_count(basis, 2), 1u);
    EXPECT_EQ(segment_count(basis, 1), 0u);
    EXPECT_EQ(segment_count(basis, 0), 0u);
  }
  EXPECT_EQ(segment_count(CurveBasis::kBSpline, 8), 5u);
  EXPECT_EQ(segment_count(CurveBasis::kBSpline, 4), 1u);
  EXPECT_EQ(segment_count(CurveBasis::kBSpline, 3), 0u);
}

TEST(Strands, InterpolatesAttributes) {
  const Strands strands(two_strands());
  float out[2] = {};
  interpolate_attribute(strands, *strands.find_attribute("hue"), 1, 2, 0.3f, out);
  EXPECT_EQ(out[0], 3);
  interpolate_attribute(strands, *strands.find_attribute("tint"), 1, 2, 0.3f, out);
  EXPECT_EQ(out[0], 3);
  EXPECT_EQ(out[1], 4);
  interpolate_attribute(strands, *strands.find_attribute("age"), 1, 0, 0.0f, out);
  EXPECT_EQ(out[0], 16);
  interpolate_attribute(strands, *strands.find_attribute("age"), 1, 3, 1.0f, out);
  EXPECT_EQ(out[0], 64);
  interpolate_attribute(strands, *strands.find_attribute("age"), 1, 1, 0.5f, out);
  EXPECT_EQ(out[0], 0.5f * (25 + 36));
}

TEST(Strands, UnpinnedSegmentsLieBetweenTheirMiddlePoints) {
  const Strands strands(two_strands(CurveBasis::kBSpline));
  float out = 0;
  interpolate_attribute(strands, *strands.find_attribute("age"), 1, 1, 0.0f, &out);
  EXPECT_EQ(out, 36);
}

TEST(Strands, OneStrandCanBeCopiedOut) {
  StrandArrays arrays = two_strands();
  arrays.motion_keys = 2;
  for (int i = 0; i < 9; ++i) arrays.points.insert(arrays.points.end(), {float(i), 1, 0, 0.25f});
  arrays.roots = {{1, 0.1f, 0.2f}, {2, 0.3f, 0.4f}};
  arrays.root_uv = {V2f(0.1f, 0.2f), V2f(0.3f, 0.4f)};
  const Strands strands(std::move(arrays));
  Strands one;
  for (size_t s : {1, 0, 1}) {
    one.assign_strand(strands, s);
    ASSERT_EQ(one.strand_count(), 1u);
    ASSERT_EQ(one.strand_points(0), strands.strand_points(s));
    EXPECT_EQ(one.motion_keys(), 2);
    EXPECT_EQ(one.id(0), strands.id(s));
    EXPECT_EQ(one.root(0).face, strands.root(s).face);
    EXPECT_EQ(one.root_uv(0), strands.root_uv(s));
    for (uint32_t i = 0; i < one.strand_points(0); ++i) {
      for (int key = 0; key < 2; ++key) {
        EXPECT_EQ(one.point(i, key), strands.point(strands.first_point(s) + i, key));
        EXPECT_EQ(one.radius(i, key), strands.radius(strands.first_point(s) + i, key));
      }
    }
    for (const char* name : {"hue", "tint", "age"}) {
      float expected[2] = {}, copied[2] = {};
      interpolate_attribute(strands, *strands.find_attribute(name), s, 2, 0.3f, expected);
      interpolate_attribute(one, *one.find_attribute(name), 0, 2, 0.3f, copied);
      EXPECT_EQ(copied[0], expected[0]) << name;
      EXPECT_EQ(copied[1], expected[1]) << name;
    }
  }
  const float* points = one.points().data();
  one.assign_strand(strands, 0);
  EXPECT_EQ(one.points().data(), points) << "memory is reused";
}

TEST(Strands, RefuseArraysThatDoNotFit) {
  const auto refusal = [](const std::function<void(StrandArrays&)>& spoil) -> std::string {
    StrandArrays arrays = two_strands();
    spoil(arrays);
    try {
      Strands strands(std::move(arrays));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      return error.what();
    }
    return "accepted";
  };
  const auto expect = [&](const char* message, const std::function<void(StrandArrays&)>& spoil) {
    EXPECT_NE(refusal(spoil).find(message), std::string::npos) << refusal(spoil);
  };
  expect("`ids` has 1 entries instead of 2", [](StrandArrays& a) { a.ids.pop_back(); });
  expect("`points`", [](StrandArrays& a) { a.points.pop_back(); });
  expect("`points`", [](StrandArrays& a) { a.first_point.clear(); });
  expect("`first_point` does not ascend", [](StrandArrays& a) { a.first_point = {0, 10, 9}; });
  expect("`first_point` does not begin with 0", [](StrandArrays& a) { a.first_point[0] = 1; });
  expect("`motion_keys`", [](StrandArrays& a) { a.motion_keys = 0; });
  expect("`roots`", [](StrandArrays& a) { a.roots.resize(1); });
  expect("`root_uv`", [](StrandArrays& a) { a.root_uv.resize(3); });
  expect("component", [](StrandArrays& a) { a.attributes[0].components = 0; });
  expect(" entries instead of ", [](StrandArrays& a) { a.attributes[2].values.push_back(0); });
}

}  // namespace
}  // namespace pelage::strands_test
