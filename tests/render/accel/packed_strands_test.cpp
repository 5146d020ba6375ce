// SPDX-License-Identifier: Apache-2.0
#include "render/accel/packed_strands.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "tests/geom/random_strands.h"

namespace pelage::packed_strands_test {
namespace {

float number(uint64_t a, uint64_t b) { return unit_float(hash64(a, b, random_use("packed test"))); }

/// Strands with everything that strands may have.
Strands rich_strands(CurveBasis basis, bool uniform, int keys, uint64_t first_id, uint64_t id_step) {
  RandomStrandOptions o;
  o.strands = 70;
  o.min_points = uniform ? 7 : 1;
  o.max_points = uniform ? 7 : 11;
  o.basis = basis;
  o.motion_keys = keys;
  StrandArrays a = Strands(random_strands(11, o)).release();
  for (size_t s = 0; s < o.strands; ++s) {
    a.ids[s] = first_id + s * id_step;
    a.roots.push_back({static_cast<uint32_t>(s * 1000), number(s, 1), number(s, 2)});
    a.root_uv.push_back(V2f(3 * number(s, 3), number(s, 4)));
  }
  const auto add = [&](const char* name, AttributeClass frequency, int components, auto&& value) {
    StrandAttribute attribute{name, frequency, components, {}};
    const size_t count = frequency == AttributeClass::kConstant    ? 1
                         : frequency == AttributeClass::kPerStrand ? o.strands
                                                                   : a.first_point.back();
    for (size_t i = 0; i < count * static_cast<size_t>(components); ++i) attribute.values.push_back(value(i));
    a.attributes.push_back(std::move(attribute));
  };
  add("hue", AttributeClass::kPerPoint, 3, [](size_t i) { return number(i, 5); });
  add("size", AttributeClass::kPerStrand, 1, [](size_t i) { return 100 * number(i, 6) - 50; });
  add("flat", AttributeClass::kPerPoint, 1, [](size_t) { return 0.25f; });
  add("byte", AttributeClass::kPerStrand, 1, [](size_t i) { return static_cast<float>(i % 256) / 255.0f; });
  add("one", AttributeClass::kConstant, 3, [](size_t i) { return static_cast<float>(i) - 1; });
  return Strands(std::move(a));
}

/// What the attribute is at a place of a strand.
std::vector<float> at(const Strands& strands, size_t attribute, size_t strand, uint32_t segment, float u) {
  const StrandAttribute& a = strands.attributes()[attribute];
  std::vector<float> value(static_cast<size_t>(a.components));
  interpolate_attribute(strands, a, strand, segment, u, value.data());
  return value;
}

class PackedStrandsTest : public testing::Test {
 protected:
  /// Compares every strand that has a segment; numbers of attributes and roots to within `error`.
  void expect_same(const Strands& strands, bool compact, float error) {
    const PackedStrands packed(strands, {}, compact, patterns_);
    Strands copy;
    uint32_t kept = 0, primitive = 0;
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      const uint32_t segments = segment_count(strands.basis(), strands.strand_points(s));
      if (segments == 0) continue;
      for (uint32_t i = 0; i < segments; ++i, ++primitive) {
        ASSERT_EQ(packed.locate(primitive).strand, kept);
        ASSERT_EQ(packed.locate(primitive).segment, i);
      }
      ASSERT_EQ(packed.id(kept), strands.id(s));
      packed.copy_strand(kept++, copy);
      Strands expected;
      expected.assign_strand(strands, s);
      ASSERT_EQ(copy.arrays().points, expected.arrays().points);
      ASSERT_EQ(copy.arrays().ids, expected.arrays().ids);
      ASSERT_EQ(copy.basis(), expected.basis());
      ASSERT_EQ(copy.root(0).face, expected.root(0).face);
      ASSERT_NEAR(copy.root(0).u, expected.root(0).u, error);
      ASSERT_NEAR(copy.root(0).v, expected.root(0).v, error);
      ASSERT_NEAR(copy.root_uv(0).x, expected.root_uv(0).x, error);
      ASSERT_EQ(copy.attributes().size(), expected.attributes().size());
      for (size_t a = 0; a < copy.attributes().size(); ++a) {
        ASSERT_EQ(copy.attributes()[a].name, expected.attributes()[a].name);
        for (uint32_t i = 0; i < segments; ++i) {
          const auto got = at(copy, a, 0, i, 0.3f), want = at(expected, a, 0, i, 0.3f);
          ASSERT_EQ(got.size(), want.size());
          for (size_t c = 0; c < got.size(); ++c) ASSERT_NEAR(got[c], want[c], error);
        }
      }
    }
    EXPECT_EQ(packed.strand_count(), kept);
    EXPECT_EQ(packed.segment_count(), primitive);
  }

  MemoryLedger ledger_;
  SegmentPatterns patterns_{ledger_};
};

TEST_F(PackedStrandsTest, GiveBackWhatWasPacked) {
  for (CurveBasis basis :
       {CurveBasis::kPinnedBSpline, CurveBasis::kCatmullRom, CurveBasis::kLinear, CurveBasis::kBSpline}) {
    for (bool uniform : {true, false}) {
      for (int keys : {1, 3}) {
        for (uint64_t step : {uint64_t(1), uint64_t(1) << 33}) {
          const Strands strands = rich_strands(basis, uniform, keys, uint64_t(1) << 50, step);
          expect_same(strands, false, 0);
          expect_same(strands, true, 0x1p-17f);
        }
      }
    }
  }
}

TEST_F(PackedStrandsTest, PhantomEndsMeetTheEndPoints) {
  const Strands strands = rich_strands(CurveBasis::kPinnedBSpline, true, 2, 0, 1);
  const PackedStrands packed(strands, {}, true, patterns_);
  for (int key = 0; key < 2; ++key) {
    for (size_t s = 0; s < packed.strand_count(); ++s) {
      const float* p = packed.vertices(key) + 4 * 9 * s;
      for (int c = 0; c < 4; ++c) {
        EXPECT_EQ(p[c], 2 * p[4 + c] - p[8 + c]);
        EXPECT_EQ(p[32 + c], 2 * p[28 + c] - p[24 + c]);
      }
    }
  }
}

TEST_F(PackedStrandsTest, KeepAttributesInTheirRarestClass) {
  const PackedStrands packed(rich_strands(CurveBasis::kPinnedBSpline, true, 1, 0, 1), {}, true, patterns_);
  Strands copy;
  packed.copy_strand(3, copy);
  EXPECT_EQ(copy.find_attribute("hue")->frequency, AttributeClass::kPerPoint);
  EXPECT_EQ(copy.find_attribute("size")->frequency, AttributeClass::kPerStrand);
  EXPECT_EQ(copy.find_attribute("flat")->frequency, AttributeClass::kConstant);
  EXPECT_EQ(copy.find_attribute("byte")->frequency, AttributeClass::kPerStrand);
  const PackedStrands fat(rich_strands(CurveBasis::kPinnedBSpline, true, 1, 0, 1), {}, false, patterns_);
  EXPECT_LT(packed.bytes() + 70 * (7 * 3 * 2 + 7 * 4), fat.bytes());
}

TEST_F(PackedStrandsTest, OpacitiesAreThoseOfThePlace) {
  for (CurveBasis basis : {CurveBasis::kPinnedBSpline, CurveBasis::kBSpline}) {
    const Strands strands = rich_strands(basis, false, 1, 0, 1);
    std::vector<float> opacity;
    for (size_t i = 0; i < strands.point_count(); ++i) opacity.push_back(packed_value(number(i, 9)));
    const PackedStrands packed(strands, opacity, true, patterns_);
    EXPECT_FALSE(packed.opaque());
    const uint32_t before = basis == CurveBasis::kBSpline ? 1 : 0;
    uint32_t primitive = 0;
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      for (uint32_t i = 0; i < segment_count(basis, strands.strand_points(s)); ++i, ++primitive) {
        const float* o = &opacity[strands.first_point(s) + i + before];
        EXPECT_EQ(packed.opacity(packed.locate(primitive), 0.25f), interpolate(o[0], o[1], 0.25f));
      }
    }
  }
  const Strands strands = rich_strands(CurveBasis::kLinear, true, 1, 0, 1);
  EXPECT_TRUE(
      PackedStrands(strands, std::vector<float>(strands.point_count(), 1.0f), true, patterns_).opaque());
  const PackedStrands half(strands, std::vector<float>(strands.point_count(), 0.5f), true, patterns_);
  EXPECT_FALSE(half.opaque());
  EXPECT_NEAR(half.opacity({5, 2}, 0.9f), 0.5f, 0x1p-17f);
}

TEST_F(PackedStrandsTest, MayBeEmpty) {
  const PackedStrands none(Strands(), {}, true, patterns_);
  EXPECT_EQ(none.strand_count(), 0u);
  EXPECT_EQ(none.segment_count(), 0u);
}

TEST_F(PackedStrandsTest, EqualBatchesShareTheirIndices) {
  const Strands strands = rich_strands(CurveBasis::kPinnedBSpline, true, 1, 0, 1);
  const PackedStrands a(strands, {}, true, patterns_), b(strands, {}, true, patterns_);
  EXPECT_EQ(a.segments(), b.segments());
  EXPECT_GT(ledger_.current(MemoryTag::kChunks), 0);
}

TEST(PackedValues, KeepTheEndsAndTheOutside) {
  for (float x : {0.0f, 1.0f, -0.5f, 1.0001f, 7e20f, -0.0f}) EXPECT_EQ(packed_value(x), x);
  EXPECT_TRUE(std::isnan(packed_value(std::nanf(""))));
  for (uint64_t i = 0; i < 10000; ++i) {
    const float x = number(i, 0), y = packed_value(x);
    EXPECT_NEAR(x, y, 0x1p-17f);
    EXPECT_EQ(packed_value(y), y);
  }
}

TEST(PackedValues, EveryPrecisionGivesTheSameBack) {
  std::vector<float> bytes, shorts;
  for (int i = 0; i < 256; ++i) bytes.push_back(packed_value(static_cast<float>(i) / 255.0f));
  for (int i = 0; i < 65536; i += 7) shorts.push_back(static_cast<float>(i) / 65535.0f);
  EXPECT_EQ(coarsest_precision(bytes), Precision::kUnorm8);
  EXPECT_EQ(coarsest_precision(shorts), Precision::kUnorm16);
  EXPECT_EQ(coarsest_precision(std::vector<float>{0.5f, 2}), Precision::kFloat);
  for (const std::vector<float>& values : {bytes, shorts}) {
    for (Precision precision : {coarsest_precision(values), Precision::kFloat}) {
      std::vector<float> packed(values.size());
      pack_values(values, precision, reinterpret_cast<std::byte*>(packed.data()));
      for (size_t i = 0; i < values.size(); ++i) {
        EXPECT_EQ(unpacked_value(reinterpret_cast<const std::byte*>(packed.data()), precision, i), values[i]);
      }
    }
  }
}

}  // namespace
}  // namespace pelage::packed_strands_test
