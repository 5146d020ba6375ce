// SPDX-License-Identifier: Apache-2.0
#include "geom/strand_merge.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

// Strands of 2 points whose coordinates are their id, so that every strand can be told apart.
StrandArrays batch(const std::vector<uint64_t>& ids) {
  StrandArrays arrays;
  arrays.first_point.push_back(0);
  for (uint64_t id : ids) {
    const float x = static_cast<float>(id);
    arrays.points.insert(arrays.points.end(), {x, 0, 0, 0.5f, x, 1, 0, 0.25f});
    arrays.first_point.push_back(arrays.first_point.back() + 2);
    arrays.ids.push_back(id);
    arrays.roots.push_back({uint32_t(id), 0.5f, 0.5f});
  }
  return arrays;
}

TEST(StrandMerge, OrdersByIdAndKeepsEveryStrand) {
  const Strands parts[] = {Strands(batch({1, 4, 5})), Strands(), Strands(batch({0, 2, 9}))};
  const Strands merged = merge(parts);
  ASSERT_EQ(merged.strand_count(), 6u);
  const uint64_t expected[] = {0, 1, 2, 4, 5, 9};
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(merged.id(i), expected[i]);
    EXPECT_EQ(merged.point(merged.first_point(i) + 1).x, static_cast<float>(expected[i]));
    EXPECT_EQ(merged.radius(merged.first_point(i) + 1), 0.25f);
    EXPECT_EQ(merged.root(i).face, expected[i]);
  }
}

TEST(StrandMerge, SparseIdsAndManyStrandsOnThreadsKeepTheOrder) {
  for (const uint64_t step : {1, 1000}) {  // dense ids are counted, sparse ones are sorted
    std::vector<uint64_t> first, second;
    for (uint64_t i = 0; i < 10000; ++i)
      (i * 7 % 10 < 4 ? first : second).push_back((i * 7919 % 10000) * step);
    second.push_back(first[0]);
    const Strands parts[] = {Strands(batch(first)), Strands(batch(second))};
    const Strands merged = merge(parts, Workers(2));
    ASSERT_EQ(merged.strand_count(), 10001u);
    size_t wrong = 0;
    for (size_t i = 1; i < merged.strand_count(); ++i)
      wrong += merged.id(i) < merged.id(i - 1) || merged.point(2 * i).x != static_cast<float>(merged.id(i));
    EXPECT_EQ(wrong, 0u);
  }
}

TEST(StrandMerge, WidensAttributeClassesAndKeepsWhatSomeBatchLacks) {
  StrandArrays a = batch({0});
  a.attributes.push_back({"color", AttributeClass::kConstant, 1, {0.5f}});
  a.attributes.push_back({"only_here", AttributeClass::kConstant, 1, {1.0f}});
  StrandArrays b = batch({1});
  b.attributes.push_back({"color", AttributeClass::kPerPoint, 1, {0.1f, 0.2f}});
  const Strands parts[] = {Strands(a), Strands(b)};
  const Strands merged = merge(parts);
  const StrandAttribute* color = merged.find_attribute("color");
  ASSERT_NE(color, nullptr);
  EXPECT_EQ(color->frequency, AttributeClass::kPerPoint);
  EXPECT_EQ(color->values, (std::vector<float>{0.5f, 0.5f, 0.1f, 0.2f}));
  const StrandAttribute* only_here = merged.find_attribute("only_here");
  ASSERT_NE(only_here, nullptr);
  EXPECT_EQ(only_here->frequency, AttributeClass::kPerStrand);
  EXPECT_EQ(only_here->values, (std::vector<float>{1, 0}));
}

TEST(StrandMerge, DifferentConstantsBecomePerStrand) {
  StrandArrays a = batch({0}), b = batch({1});
  a.attributes.push_back({"tint", AttributeClass::kConstant, 1, {0.5f}});
  b.attributes.push_back({"tint", AttributeClass::kConstant, 1, {0.75f}});
  const Strands parts[] = {Strands(b), Strands(a)};
  const Strands merged = merge(parts);
  const StrandAttribute* tint = merged.find_attribute("tint");
  ASSERT_NE(tint, nullptr);
  EXPECT_EQ(tint->values, (std::vector<float>{0.5f, 0.75f}));
}

TEST(StrandMerge, StrandsWithoutColorAreWhite) {
  StrandArrays b = batch({1});
  b.attributes.push_back({"color", AttributeClass::kPerPoint, 3, {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f}});
  b.attributes.push_back({"odd", AttributeClass::kConstant, 2, {1, 2}});
  StrandArrays c = batch({2});
  c.attributes.push_back({"odd", AttributeClass::kConstant, 1, {1}});
  const Strands parts[] = {Strands(batch({0})), Strands(b), Strands(c)};
  const Strands merged = merge(parts);
  EXPECT_EQ(merged.find_attribute("color")->values,
            (std::vector<float>{1, 1, 1, 1, 1, 1, 0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 1, 1, 1, 1, 1, 1}));
  EXPECT_EQ(merged.find_attribute("odd"), nullptr) << "different numbers of components";
}

TEST(StrandMerge, OfNothingIsNothing) { EXPECT_EQ(merge({}).strand_count(), 0u); }

}  // namespace
}  // namespace pelage
