// SPDX-License-Identifier: Apache-2.0
#include "procedurals/bounds/segment_cell_bounds.h"

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

float number(uint64_t seed, uint64_t use) {
  return signed_float(hash64(seed, use, random_use("cell bounds")));
}

V3f vector(uint64_t seed, uint64_t use) {
  return {number(seed, 3 * use), number(seed, 3 * use + 1), number(seed, 3 * use + 2)};
}

std::vector<Box3f> random_boxes(uint64_t seed, size_t count, size_t keys, const V3f& place, float size) {
  std::vector<Box3f> boxes;
  for (size_t i = 0; i < count * keys; ++i) {
    const V3f middle = place + vector(hash64(seed, i / keys), 1) + 0.2f * vector(hash64(seed, i), 2);
    V3f half = size * vector(hash64(seed, i), 3);
    for (int axis = 0; axis < 3; ++axis) half[axis] = std::abs(half[axis]);
    boxes.push_back({middle - half, middle + half});
  }
  return boxes;
}

bool holds(const Box3f& outer, const Box3f& inner, float rounding) {
  const V3f r(rounding);
  return Box3f(outer.min - r, outer.max + r).intersects(inner.min) &&
         Box3f(outer.min - r, outer.max + r).intersects(inner.max);
}

TEST(SegmentCellBounds, HoldWhatTheyAreMadeOfAndLittleMore) {
  for (size_t count : {1u, 3u, 4u, 5u, 16u, 17u, 175u, 1025u}) {
    for (size_t keys : {1u, 2u, 3u, 5u}) {
      const V3f place = 100.0f * vector(count, keys);
      const std::vector<Box3f> boxes = random_boxes(count + 7 * keys, count, keys, place, 0.1f);
      const SegmentCellBounds cell_bounds(boxes, keys);
      ASSERT_EQ(cell_bounds.count(), count);
      EXPECT_TRUE(cell_bounds.is_possible());
      EXPECT_LE(cell_bounds.bytes(), 24 * (count / 3 + 8));
      for (size_t b = 0; b < count; ++b) {
        V3f gap(0);
        for (size_t k = 0; k < keys; ++k) {
          const float time = keys < 2 ? 0 : static_cast<float>(k) / static_cast<float>(keys - 1);
          const Box3f held = cell_bounds.box(b, time);
          EXPECT_TRUE(holds(held, boxes[b * keys + k], 1e-4f)) << count << " " << keys << " " << b;
          gap = held.size() - boxes[b * keys + k].size();
        }
        for (int axis = 0; axis < 3 && keys == 1; ++axis) {
          EXPECT_LE(gap[axis], 2.01f * cell_bounds.grid().step[axis] + 1e-4f);
          EXPECT_LE(cell_bounds.grid().step[axis], 2.5f / 255);
        }
      }
    }
  }
}

TEST(SegmentCellBounds, BoxesOfEachLevelHoldFourOfTheLevelBelow) {
  for (size_t count : {1u, 4u, 5u, 64u, 65u, 700u}) {
    const SegmentCellBounds cell_bounds(random_boxes(count, count, 1, V3f(0), 0.05f), 1);
    ASSERT_EQ(cell_bounds.level(cell_bounds.levels() - 1).size(), 1u);
    size_t boxes = count;
    for (size_t level = 0; level < cell_bounds.levels(); ++level) {
      ASSERT_EQ(cell_bounds.level(level).size(), (boxes + 3) / 4);
      for (size_t b = 0; b < 4 * cell_bounds.level(level).size(); ++b) {
        for (size_t axis = 0; axis < 3; ++axis) {
          const auto& sides = cell_bounds.level(level)[b / 4][axis];
          const int low = sides[0][b % 4], high = sides[1][b % 4];
          EXPECT_EQ(low <= high, b < boxes);
          if (level == 0 || b >= boxes) continue;
          int lowest = 255, highest = 0;
          for (size_t lane = 0; lane < 4; ++lane) {
            lowest = std::min<int>(lowest, cell_bounds.level(level - 1)[b][axis][0][lane]);
            highest = std::max<int>(highest, cell_bounds.level(level - 1)[b][axis][1][lane]);
          }
          EXPECT_EQ(low, lowest);
          EXPECT_EQ(high, highest);
        }
      }
      boxes = cell_bounds.level(level).size();
    }
  }
}

TEST(SegmentCellBounds, StandEverySize) {
  for (const V3f& half : {V3f(0), V3f(0, 1, 0), V3f(1e-30f), V3f(1e18f, 1e-18f, 1), V3f(3e37f)}) {
    for (const V3f& middle : {V3f(0), V3f(-1e6f, 1, 1e-20f)}) {
      const Box3f box(middle - half, middle + half);
      const SegmentCellBounds cell_bounds(std::vector<Box3f>(5, box), 1);
      EXPECT_TRUE(cell_bounds.is_possible());
      const float size = std::max({box.max.length(), box.min.length(), 1e-30f});
      for (size_t b = 0; b < 5; ++b) EXPECT_TRUE(holds(cell_bounds.box(b, 0), box, 4e-7f * size)) << half.x;
    }
  }
  EXPECT_EQ(SegmentCellBounds().count(), 0u);
  EXPECT_EQ(SegmentCellBounds({}, 1).count(), 0u);
}

TEST(SegmentCellBounds, ComeBackAsTheyWereWritten) {
  const SegmentCellBounds cell_bounds(random_boxes(3, 77, 2, V3f(4, 5, 6), 0.1f), 2);
  const SegmentCellBounds read(cell_bounds.grid(), cell_bounds.level(0), cell_bounds.count());
  ASSERT_EQ(read.levels(), cell_bounds.levels());
  for (size_t level = 0; level < cell_bounds.levels(); ++level) {
    EXPECT_TRUE(std::equal(cell_bounds.level(level).begin(), cell_bounds.level(level).end(),
                           read.level(level).begin()));
  }
  SegmentCellBounds::Grid wrong = cell_bounds.grid();
  wrong.step.y = -1;
  EXPECT_FALSE(SegmentCellBounds(wrong, cell_bounds.level(0), cell_bounds.count()).is_possible());
  wrong.step.y = NAN;
  EXPECT_FALSE(SegmentCellBounds(wrong, cell_bounds.level(0), cell_bounds.count()).is_possible());
  std::vector<SegmentCellBounds::Group> groups(cell_bounds.level(0).begin(), cell_bounds.level(0).end());
  std::swap(groups[2][1][0], groups[2][1][1]);
  EXPECT_FALSE(SegmentCellBounds(cell_bounds.grid(), groups, cell_bounds.count()).is_possible());
}

}  // namespace
}  // namespace pelage
