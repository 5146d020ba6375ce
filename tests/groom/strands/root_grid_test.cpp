// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/root_grid.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/groom/operator_harness.h"
#include "tests/support/effort.h"

namespace pelage::root_grid_test {
namespace {

struct Places {
  std::vector<V3f> positions, normals;

  Places(size_t count, const V3f& middle, float size, TestRandom& random) {
    for (size_t i = 0; i < count; ++i) {
      // Every fourth place coincides with an earlier one, so that distances are equal.
      const bool again = i % 4 == 3;
      positions.push_back(again ? positions[i / 2] : middle + random.direction() * (size * random.unit()));
      normals.push_back(random.direction());
    }
  }
};

/// The nearest place as RootGrid::nearest_if() defines it, by looking at all places.
template <class Accept>
bool nearest_of_all(const Places& places, float radius, const V3f& position, const V3f& normal,
                    RootGrid::Neighbour& result, const Accept& accept) {
  float best = radius * radius;
  bool found = false;
  for (uint32_t i = 0; i < places.positions.size(); ++i) {
    const V3f d = places.positions[i] - position;
    const float distance2 = d.dot(d);
    if (distance2 > best || (found && distance2 == best)) continue;
    if (!RootGrid::same_side(places.normals[i], normal) || !accept(i)) continue;
    found = true;
    best = distance2;
    result = {i, std::sqrt(distance2)};
  }
  return found;
}

TEST(RootGrid, FindsTheNearestPlaceOfAll) {
  TestRandom random(47);
  const auto all = [](uint32_t) { return true; };
  const auto some = [](uint32_t i) { return i % 3 != 0; };
  for (const V3f& middle : {V3f(0), V3f(-3, 500, 2e4f)}) {
    // From cells with hundreds of places to cells that are mostly empty.
    for (const float radius : {0.02f, 0.1f, 0.4f, 3.0f}) {
      const Places places(800, middle, 1, random);
      const RootGrid grid(places.positions, places.normals, radius);
      int found = 0;
      for (uint64_t i = 0; i < repetitions(2000); ++i) {
        const bool at_place = i % 5 == 0;
        const V3f position = at_place ? places.positions[i % places.positions.size()]
                                      : middle + random.direction() * (1.3f * random.unit());
        const V3f normal = random.direction();
        RootGrid::Neighbour fast, slow;
        const bool any = nearest_of_all(places, radius, position, normal, slow, all);
        ASSERT_EQ(grid.nearest(position, normal, fast), any) << i;
        found += any;
        if (any) {
          ASSERT_EQ(fast.index, slow.index) << i;
          ASSERT_EQ(fast.distance, slow.distance) << i;
        }
        const bool other = nearest_of_all(places, radius, position, normal, slow, some);
        ASSERT_EQ(grid.nearest_if(position, normal, fast, some), other) << i;
        if (other) {
          ASSERT_EQ(fast.index, slow.index) << i;
        }
      }
      EXPECT_GT(found, 0) << radius;
    }
  }
}

TEST(RootGrid, FindsNothingWhereThereIsNothing) {
  RootGrid::Neighbour result;
  EXPECT_FALSE(RootGrid().nearest(V3f(0), V3f(0, 0, 1), result));
  const RootGrid one({V3f(1, 0, 0)}, {V3f(0, 0, 1)}, 0.5f);
  EXPECT_FALSE(one.nearest(V3f(0), V3f(0, 0, 1), result));
  EXPECT_FALSE(one.nearest(V3f(1, 0, 0), V3f(0, 0, -1), result));
  EXPECT_TRUE(one.nearest(V3f(0.75f, 0, 0), V3f(0, 0, 1), result));
  EXPECT_EQ(result.distance, 0.25f);
}

}  // namespace
}  // namespace pelage::root_grid_test
