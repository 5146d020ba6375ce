// SPDX-License-Identifier: Apache-2.0
#include "rib/scene/rib_batches.h"

#include <limits>

#include <gtest/gtest.h>

namespace pelage::rib_batches_test {
namespace {

StrandArrays lines(size_t count, float value = 1) {
  StrandArrays a;
  a.basis = CurveBasis::kLinear;
  a.first_point = {0};
  for (size_t s = 0; s < count; ++s) {
    const auto x = static_cast<float>(s);
    a.points.insert(a.points.end(), {x, 0, 0, .1f, x, 1, 0, .1f});
    a.first_point.push_back(static_cast<uint32_t>(2 * s + 2));
    a.ids.push_back(s);
  }
  a.attributes = {{"k", AttributeClass::kConstant, 1, {value}}};
  a.attributes.push_back({"p", AttributeClass::kPerPoint, 1, std::vector<float>(2 * count, value)});
  return a;
}

TEST(RibBatches, FullBatchesArePassedOnInOrder) {
  std::vector<std::pair<size_t, size_t>> taken;
  std::vector<uint64_t> ids;
  RibBatches batches([&](size_t coat, Strands strands) {
    taken.emplace_back(coat, strands.strand_count());
    for (size_t s = 0; s < strands.strand_count() && coat == 0; ++s) {
      ids.push_back(strands.id(s));
      EXPECT_EQ(strands.point(2 * s).x, static_cast<float>(strands.id(s)));
    }
  });
  const size_t max = RibBatches::kMaxStrands;
  batches.add(1, lines(5));
  batches.add(0, lines(2 * max + 7));
  batches.add(1, lines(6));
  EXPECT_EQ(taken, (std::vector<std::pair<size_t, size_t>>{{0, max}, {0, max}}));
  batches.finish();
  EXPECT_EQ(taken.size(), 4u);
  EXPECT_EQ(taken[2], (std::pair<size_t, size_t>{1, 11}));
  EXPECT_EQ(taken[3], (std::pair<size_t, size_t>{0, 7}));
  ASSERT_EQ(ids.size(), 2 * max + 7);
  for (size_t i = 0; i < ids.size(); ++i) ASSERT_EQ(ids[i], i);
}

TEST(RibBatches, OtherAttributesBeginAnotherBatch) {
  size_t count = 0;
  RibBatches batches([&](size_t, Strands) { ++count; });
  batches.add(0, lines(2, 1));
  batches.add(0, lines(2, 2));  // another value of the constant
  batches.add(0, lines(2, 1));
  batches.finish();
  EXPECT_EQ(count, 2u);
}

TEST(RibBatches, MotionIsResampledToTheShutter) {
  StrandArrays a = lines(1);
  a.motion_keys = 2;
  for (size_t i = 0; i < 8; ++i) a.points.push_back(a.points[i] + (i % 4 == 2 ? 4.0f : 0.0f));
  size_t dropped = 0;
  RibShutter shutter;
  shutter.times = V2f(0.25f, 0.75f);
  const StrandArrays world = to_world(a, {0, 1}, RibTransform(), shutter, dropped);
  EXPECT_EQ(world.motion_keys, 2);
  EXPECT_FLOAT_EQ(world.points[2], 1);
  EXPECT_FLOAT_EQ(world.points[8 + 2], 3);
  shutter.times = V2f(0.5f, 0.5f);
  EXPECT_EQ(to_world(a, {0, 1}, RibTransform(), shutter, dropped).motion_keys, 1);
  EXPECT_EQ(dropped, 0u);
}

TEST(RibBatches, TransformsScaleRadii) {
  size_t dropped = 0;
  const StrandArrays world = to_world(lines(2), {}, RibTransform(M44f().setScale(3.0f)), {}, dropped);
  EXPECT_FLOAT_EQ(world.points[3], .3f);
  EXPECT_FLOAT_EQ(world.points[8], 3);
}

TEST(RibBatches, DropsStrandsThatCannotBeDrawn) {
  StrandArrays a = lines(4);
  a.points[8 * 1 + 0] = std::numeric_limits<float>::quiet_NaN();
  a.points[8 * 2 + 4] = 2e18f;
  a.points[8 * 3 + 5] = 0;  // both ends at one point
  a.points[3] = -1;
  a.attributes[1].values[0] = std::numeric_limits<float>::infinity();
  size_t dropped = 0;
  const StrandArrays world = to_world(a, {}, RibTransform(), {}, dropped);
  EXPECT_EQ(dropped, 3u);
  const Strands strands(world);
  ASSERT_EQ(strands.strand_count(), 1u);
  EXPECT_EQ(strands.id(0), 0u);
  EXPECT_EQ(strands.radius(0), 0);
  EXPECT_EQ(strands.find_attribute("p")->values[0], 0);
  EXPECT_EQ(strands.find_attribute("p")->values.size(), 2u);
}

}  // namespace
}  // namespace pelage::rib_batches_test
