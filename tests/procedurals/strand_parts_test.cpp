// SPDX-License-Identifier: Apache-2.0
#include "procedurals/strand_parts.h"

#include <gtest/gtest.h>

#include "geom/curve_bounds.h"
#include "tests/geom/random_strands.h"

namespace pelage {
namespace {

float surface_area(const Box3f& box) {
  const V3f d = box.size();
  return 2 * (d.x * d.y + d.y * d.z + d.z * d.x);
}

TEST(StrandParts, HoldEveryStrandOnceInPartsOfEqualSize) {
  for (size_t count : {1u, 2u, 255u, 256u, 257u, 1000u, 3001u}) {
    const Strands strands = random_strands(count, {.strands = count});
    const StrandParts parts = divide_into_parts(strands, 256);
    ASSERT_EQ(parts.count(), (count + 255) / 256);
    std::vector<int> seen(count, 0);
    size_t least = count, most = 0;
    for (size_t p = 0; p < parts.count(); ++p) {
      least = std::min(least, parts.part(p).size());
      most = std::max(most, parts.part(p).size());
      for (uint32_t strand : parts.part(p)) ++seen[strand];
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<ptrdiff_t>(count));
    EXPECT_LE(most, 256u);
    EXPECT_LE(most - least, 1u + most / 8) << count;
  }
  EXPECT_EQ(divide_into_parts(Strands()).count(), 0u);
  EXPECT_TRUE(exact_part_bounds(Strands(), {}, 1).boxes.empty());
}

TEST(StrandParts, AreCompact) {
  const Strands strands = random_strands(4, {.strands = 4096, .step = 0.02f});
  const ChunkBounds bounds = exact_part_bounds(strands, divide_into_parts(strands, 64), 1);
  ASSERT_EQ(bounds.boxes.size(), 64u);
  double sum = 0;
  for (const Box3f& box : bounds.boxes) sum += surface_area(box);
  // Roots fill a cube, so 64 cubes of a quarter of its side would have 4 times its surface between them.
  EXPECT_LT(sum / surface_area(bounds.whole()), 7);
}

TEST(StrandParts, OneKeyIsTheExactBoxOfThePart) {
  const Strands strands = random_strands(5, {.strands = 300, .motion_keys = 3});
  const StrandParts parts = divide_into_parts(strands, 50);
  const ChunkBounds bounds = exact_part_bounds(strands, parts, 1);
  ASSERT_EQ(bounds.part_count(), parts.count());
  for (size_t p = 0; p < parts.count(); ++p) {
    Box3f box;
    for (uint32_t strand : parts.part(p)) {
      for (uint32_t s = 0; s < segment_count(strands.basis(), strands.strand_points(strand)); ++s) {
        for (float time : {0.0f, 0.5f, 1.0f}) {
          box.extendBy(exact_bounds(bezier_segment_at(strands, strand, s, time)));
        }
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(bounds.box(p, 0).min[axis], box.min[axis], 2e-6);
      EXPECT_NEAR(bounds.box(p, 0).max[axis], box.max[axis], 2e-6);
    }
  }
}

// As whoever traces rays interpolates them.
Box3f at_time(const ChunkBounds& bounds, size_t part, float time) {
  const Box3f &a = bounds.box(part, 0), &b = bounds.box(part, 1);
  return {(1 - time) * a.min + time * b.min, (1 - time) * a.max + time * b.max};
}

TEST(StrandParts, TwoKeysHoldThePartAtEveryTime) {
  for (int keys : {1, 2, 3, 4, 7}) {
    const Strands strands =
        random_strands(6, {.strands = 60, .motion_keys = keys, .centre = V3f(20, -300, 5)});
    const StrandParts parts = divide_into_parts(strands, 20);
    const ChunkBounds bounds = exact_part_bounds(strands, parts, 2);
    ASSERT_EQ(bounds.boxes.size(), 2 * parts.count());
    for (size_t p = 0; p < parts.count(); ++p) {
      for (int step = 0; step <= 60; ++step) {
        const float time = static_cast<float>(step) / 60;
        const Box3f box = at_time(bounds, p, time);
        for (uint32_t strand : parts.part(p)) {
          for (uint32_t s = 0; s < segment_count(strands.basis(), strands.strand_points(strand)); ++s) {
            const CubicSegment segment = bezier_segment_at(strands, strand, s, time);
            for (float t : {0.0f, 0.2f, 0.5f, 0.7f, 1.0f}) {
              const V3f at = curve_position(segment, t), reach(curve_radius(segment, t));
              ASSERT_TRUE(box.intersects(at - reach) && box.intersects(at + reach)) << keys << " " << time;
            }
          }
        }
      }
    }
  }
}

TEST(StrandParts, TwoKeysAreExactAtTheEndsOfAStraightMotion) {
  const Strands strands = random_strands(7, {.strands = 40, .motion_keys = 2, .motion = 1});
  const StrandParts parts = divide_into_parts(strands, 40);
  const ChunkBounds bounds = exact_part_bounds(strands, parts, 2);
  for (int key : {0, 1}) {
    const Box3f exact = exact_bounds(strands, static_cast<float>(key), static_cast<float>(key));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(bounds.box(0, key).min[axis], exact.min[axis], 1e-5);
      EXPECT_NEAR(bounds.box(0, key).max[axis], exact.max[axis], 1e-5);
    }
  }
}

TEST(InterpolateBoxes, WidenOnlyWhereAKeyBetweenSticksOut) {
  const auto box = [](float low, float high) { return Box3f(V3f(low, 0, 0), V3f(high, 1, 1)); };
  const Box3f boxes[] = {box(0, 1), box(2, 5), box(2, 3)};
  Box3f open, close;
  interpolate_boxes(boxes, open, close);
  // Half way there is room for 1 .. 2; the box of 2 .. 5 sticks out by 3 at the upper side and not below.
  EXPECT_NEAR(open.min.x, 0, 1e-5);
  EXPECT_NEAR(close.min.x, 2, 1e-5);
  EXPECT_NEAR(open.max.x, 4, 1e-5);
  EXPECT_NEAR(close.max.x, 6, 1e-5);
  EXPECT_NEAR(open.max.y, 1, 1e-5);
  const Box3f empty[2];
  interpolate_boxes(empty, open, close);
  EXPECT_TRUE(open.isEmpty());
}

}  // namespace
}  // namespace pelage
