// SPDX-License-Identifier: Apache-2.0
#include "rib/syntax/rib_curves.h"

#include <gtest/gtest.h>

#include "tests/geom/random_strands.h"
#include "tests/rib/syntax/rib_tokens.h"

namespace pelage::rib_curves_test {
namespace {

std::string written(const Strands& strands, RibEncoding encoding) {
  RibText text;
  RibWriter rib(text, encoding);
  std::vector<float> times;
  for (int key = 0; key < strands.motion_keys(); ++key)
    times.push_back(-0.25f + 0.5f * static_cast<float>(key));
  write_curves(rib, strands, times);
  rib.end_line();
  rib.flush();
  return text.text();
}

struct CurvesCase {
  CurveBasis basis;
  const char* type;
  const char* name;
  size_t phantoms;
  const char* frequency;
};

class RibCurvesOfBasis : public testing::TestWithParam<CurvesCase> {};

TEST_P(RibCurvesOfBasis, CarryEveryPointWidthAndId) {
  const CurvesCase& c = GetParam();
  for (const int keys : {1, 2, 3}) {
    const Strands strands =
        random_strands(7, {.strands = 30, .min_points = 4, .motion_keys = keys, .basis = c.basis});
    for (const RibEncoding encoding : {RibEncoding::kAscii, RibEncoding::kBinary}) {
      const auto requests = rib_requests(written(strands, encoding));
      std::vector<const RibRequest*> curves;
      for (const RibRequest& r : requests) {
        if (r.name == "Curves") curves.push_back(&r);
        if (r.name == "Basis") {
          EXPECT_EQ(r.arguments[0].texts[0], c.name);
        }
      }
      EXPECT_EQ(requests.size(), static_cast<size_t>(keys + (keys > 1 ? 2 : 0) + (*c.name ? 1 : 0)));
      ASSERT_EQ(curves.size(), static_cast<size_t>(keys));
      for (int key = 0; key < keys; ++key) {
        const RibRequest& one = *curves[static_cast<size_t>(key)];
        EXPECT_EQ(one.arguments[0].texts[0], c.type);
        const auto& p = one.parameter("P").numbers;
        const auto& width = one.parameter(std::string(c.frequency) + " float width").numbers;
        const auto& id = one.parameter("uniform integer id").numbers;
        ASSERT_EQ(p.size(), 3 * (strands.point_count() + 2 * c.phantoms * strands.strand_count()));
        ASSERT_EQ(width.size(), strands.point_count());
        size_t at = 0;
        const auto point = [&](size_t i) {
          return V3f(static_cast<float>(p[3 * i]), static_cast<float>(p[3 * i + 1]),
                     static_cast<float>(p[3 * i + 2]));
        };
        for (size_t s = 0; s < strands.strand_count(); ++s) {
          const size_t count = strands.strand_points(s), first = strands.first_point(s);
          EXPECT_EQ(one.arguments[1].numbers[s], static_cast<double>(count + 2 * c.phantoms));
          EXPECT_EQ(id[s], static_cast<double>(strands.id(s)));
          if (c.phantoms) {
            EXPECT_EQ(point(at), 2.0f * strands.point(first, key) - strands.point(first + 1, key));
            EXPECT_EQ(point(at + count + 1),
                      2.0f * strands.point(first + count - 1, key) - strands.point(first + count - 2, key));
          }
          for (size_t i = 0; i < count; ++i) {
            EXPECT_EQ(point(at + c.phantoms + i), strands.point(first + i, key));
            EXPECT_EQ(static_cast<float>(width[first + i]), 2.0f * strands.radius(first + i, key));
          }
          at += count + 2 * c.phantoms;
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    all, RibCurvesOfBasis,
    testing::Values(CurvesCase{CurveBasis::kPinnedBSpline, "cubic", "b-spline", 1, "varying"},
                    CurvesCase{CurveBasis::kCatmullRom, "cubic", "catmull-rom", 1, "varying"},
                    CurvesCase{CurveBasis::kBSpline, "cubic", "b-spline", 0, "vertex"},
                    CurvesCase{CurveBasis::kLinear, "linear", "", 0, "varying"}));

TEST(RibCurves, IdsLoseNoBit) {
  StrandArrays arrays = random_strands(1, {.strands = 3}).arrays();
  arrays.ids = {5, 0xdeadbeefcafe0123ull, 0x80000000ull};
  const auto requests = rib_requests(written(Strands(arrays), RibEncoding::kBinary));
  const auto& low = requests[1].parameter("uniform integer id").numbers;
  const auto& high = requests[1].parameter("uniform integer id_high").numbers;
  for (size_t s = 0; s < 3; ++s) {
    const auto part = [](double v) {
      return static_cast<uint64_t>(static_cast<uint32_t>(static_cast<int32_t>(v)));
    };
    EXPECT_EQ(part(high[s]) << 32 | part(low[s]), arrays.ids[s]);
  }
}

TEST(RibCurves, AttributesBecomeParameters) {
  StrandArrays arrays = random_strands(2, {.strands = 4, .min_points = 3, .max_points = 3}).arrays();
  arrays.root_uv.assign(4, V2f(0.25f, 0.5f));
  arrays.attributes = {{"color", AttributeClass::kPerPoint, 3, std::vector<float>(36, 0.5f)},
                       {"wet hair", AttributeClass::kPerStrand, 1, {1, 2, 3, 4}},
                       {"flow", AttributeClass::kConstant, 2, {7, 8}},
                       {"Pref", AttributeClass::kPerStrand, 3, std::vector<float>(12, 2)}};
  const auto requests = rib_requests(written(Strands(arrays), RibEncoding::kAscii));
  EXPECT_EQ(requests[1].parameter("varying color Cs").numbers.size(), 36u);
  EXPECT_EQ(requests[1].parameter("uniform float wet_hair").numbers, (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(requests[1].parameter("constant float[2] flow").numbers, (std::vector<double>{7, 8}));
  EXPECT_EQ(requests[1].parameter("uniform float[2] st").numbers.size(), 8u);
  EXPECT_EQ(requests[1].parameter("uniform point Pref").numbers, std::vector<double>(12, 2));
}

TEST(RibCurves, BinaryStrandOfEightPointsTakes160Bytes) {
  const Strands plain = random_strands(3, {.strands = 1000, .min_points = 8, .max_points = 8});
  RibText text;
  RibWriter rib(text, RibEncoding::kBinary);
  RibCurves curves;
  make_rib_curves(plain, 0, curves);
  rib.request("Curves").text(curves.type).integers(curves.vertices).text("nonperiodic");
  for (size_t i = 0; i < 2; ++i)
    rib.parameter(curves.parameters[i].declaration).numbers(curves.parameters[i].numbers);
  rib.flush();
  EXPECT_LE(text.text().size(), 160u * 1000);

  StrandArrays arrays = plain.arrays();
  for (size_t s = 0; s < 1000; ++s) arrays.ids[s] = 0x7fffff00u + s;  // as long as a number can be
  arrays.root_uv.assign(1000, V2f(0.3f));
  arrays.attributes = {{"color", AttributeClass::kPerStrand, 3, std::vector<float>(3000, 0.5f)}};
  EXPECT_LE(written(Strands(arrays), RibEncoding::kBinary).size(), 190u * 1000);
}

TEST(RibCurves, NoStrandsGiveNoRequest) { EXPECT_EQ(written(Strands(), RibEncoding::kAscii), ""); }

}  // namespace
}  // namespace pelage::rib_curves_test
