// SPDX-License-Identifier: Apache-2.0
#include "procedurals/bounds/segment_parts.h"

#include <map>
#include <span>
#include <utility>

#include <gtest/gtest.h>

#include "geom/curve_bounds.h"
#include "tests/geom/random_strands.h"

namespace pelage::segment_parts_test {
namespace {

float surface_area(const Box3f& box) {
  const V3f d = box.size();
  return 2 * (d.x * d.y + d.y * d.z + d.z * d.x);
}

TEST(SegmentParts, HoldEverySegmentOnceInCellsOfEqualSize) {
  for (size_t count : {1u, 2u, 31u, 32u, 33u, 500u, 1701u}) {
    const Strands strands = random_strands(count, {.strands = count});
    const SegmentDivision division{.cell_segments = 20, .part_cells = 8};
    const SegmentParts parts(strands, division);
    std::map<std::pair<uint32_t, uint32_t>, int> seen;
    size_t min = SIZE_MAX, max = 0, total = 0;
    for (size_t c = 0; c < parts.cell_count(); ++c) {
      min = std::min(min, parts.cell(c).size());
      max = std::max(max, parts.cell(c).size());
      for (SegmentPlace place : parts.cell(c)) ++seen[{place.strand, place.segment}];
    }
    for (size_t s = 0; s < count; ++s) total += segment_count(strands.basis(), strands.strand_points(s));
    ASSERT_EQ(parts.cell_count(), (total + 19) / 20);
    ASSERT_EQ(parts.part_count(), (parts.cell_count() + 7) / 8);
    EXPECT_EQ(seen.size(), total);
    for (const auto& [place, times] : seen) EXPECT_EQ(times, 1);
    EXPECT_LE(max, 20u);
    EXPECT_GE(min + 1, max);
    size_t in_parts = 0;
    for (size_t p = 0; p < parts.part_count(); ++p) in_parts += parts.part(p).size();
    EXPECT_EQ(in_parts, total);
    EXPECT_EQ(parts.exact_bounds(1).part_count(), parts.part_count());
  }
  const ChunkBounds none = SegmentParts(Strands()).exact_bounds(1);
  EXPECT_TRUE(none.boxes.empty());
  EXPECT_EQ(none.cell_bounds.count(), 0u);
}

TEST(SegmentParts, AreCompact) {
  const Strands strands =
      random_strands(4, {.strands = 4096, .min_points = 2, .max_points = 2, .step = 0.001f, .radius = 0});
  const ChunkBounds bounds = SegmentParts(strands, {.cell_segments = 8, .part_cells = 8}).exact_bounds(1);
  ASSERT_EQ(bounds.boxes.size(), 64u);
  double sum = 0;
  for (const Box3f& box : bounds.boxes) sum += surface_area(box);
  // Roots fill a cube, so 64 cubes of a quarter of its side would have 4 times its surface between them, and
  // 512 of an eighth 8 times.
  EXPECT_LT(sum / surface_area(bounds.whole()), 4.5);
  double cell_bounds = 0;
  for (size_t c = 0; c < bounds.cell_bounds.count(); ++c)
    cell_bounds += surface_area(bounds.cell_bounds.box(c, 0));
  EXPECT_LT(cell_bounds / surface_area(bounds.whole()), 9);
}

TEST(SegmentParts, OneKeyIsTheExactBoxOfThePart) {
  const Strands strands = random_strands(5, {.strands = 300, .motion_keys = 3});
  const SegmentParts parts(strands, {.cell_segments = 25, .part_cells = 4});
  const ChunkBounds bounds = parts.exact_bounds(1);
  ASSERT_EQ(bounds.part_count(), parts.part_count());
  for (size_t p = 0; p < parts.part_count(); ++p) {
    Box3f box;
    for (const SegmentPlace place : parts.part(p)) {
      for (float time : {0.0f, 0.5f, 1.0f}) {
        box.extendBy(exact_bounds(bezier_segment_at(strands, place.strand, place.segment, time)));
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(bounds.box(p, 0).min[axis], box.min[axis], 2e-6);
      EXPECT_NEAR(bounds.box(p, 0).max[axis], box.max[axis], 2e-6);
    }
  }
}

// As interpolated by ray tracing.
Box3f interpolated_box(const ChunkBounds& bounds, size_t part, float time) {
  const Box3f &a = bounds.box(part, 0), &b = bounds.box(part, bounds.keys - 1);
  return {(1 - time) * a.min + time * b.min, (1 - time) * a.max + time * b.max};
}

void expect_held(const Box3f& box, std::span<const SegmentPlace> places, const Strands& strands, float time) {
  size_t outside = 0;
  for (const SegmentPlace place : places) {
    const CubicSegment segment = bezier_segment_at(strands, place.strand, place.segment, time);
    for (float t : {0.0f, 0.2f, 0.5f, 0.7f, 1.0f}) {
      const V3f at = curve_position(segment, t), reach(curve_radius(segment, t));
      outside += !(box.intersects(at - reach) && box.intersects(at + reach));
    }
  }
  EXPECT_EQ(outside, 0u) << "at " << time;
}

TEST(SegmentParts, HoldTheirSegmentsAtEveryTime) {
  for (int bound_keys : {1, 2}) {
    for (int keys : {1, 2, 3, 4, 7}) {
      const Strands strands =
          random_strands(6, {.strands = 60, .motion_keys = keys, .centre = V3f(20, -300, 5)});
      const SegmentParts parts(strands, {.cell_segments = 11, .part_cells = 4});
      const ChunkBounds bounds = parts.exact_bounds(bound_keys);
      ASSERT_EQ(bounds.part_count(), parts.part_count());
      ASSERT_EQ(bounds.cell_bounds.count(), parts.cell_count());
      // Sides are handed out as floats, which resolve no more than this at that distance.
      const V3f rounding(0x1p-22f * 300);
      for (int step = 0; step <= 60; ++step) {
        const float time = static_cast<float>(step) / 60;
        for (size_t p = 0; p < parts.part_count(); ++p) {
          expect_held(interpolated_box(bounds, p, time), parts.part(p), strands, time);
        }
        for (size_t c = 0; c < parts.cell_count(); ++c) {
          const Box3f box = bounds.cell_bounds.box(c, time);
          expect_held({box.min - rounding, box.max + rounding}, parts.cell(c), strands, time);
        }
      }
    }
  }
}

TEST(SegmentParts, TwoKeysAreExactAtTheEndsOfAStraightMotion) {
  const Strands strands = random_strands(7, {.strands = 40, .motion_keys = 2, .motion = 1});
  const ChunkBounds bounds = SegmentParts(strands, {.cell_segments = 8, .part_cells = 4}).exact_bounds(2);
  for (int key : {0, 1}) {
    const Box3f exact = exact_bounds(strands, static_cast<float>(key), static_cast<float>(key));
    Box3f all;
    for (size_t p = 0; p < bounds.part_count(); ++p) all.extendBy(bounds.box(p, key));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(all.min[axis], exact.min[axis], 1e-5);
      EXPECT_NEAR(all.max[axis], exact.max[axis], 1e-5);
    }
  }
}

// A chunk that moves as a whole has cell bounds as small as those of a static one.
TEST(SegmentParts, SegmentCellBoundsMoveWithTheChunk) {
  StrandArrays arrays = Strands(random_strands(8, {.strands = 300})).release();
  const ChunkBounds still = SegmentParts(Strands(arrays)).exact_bounds(2);
  const size_t floats = arrays.points.size();
  for (size_t i = 0; i < floats; ++i) arrays.points.push_back(arrays.points[i] + (i % 4 == 0 ? 5.0f : 0.0f));
  arrays.motion_keys = 2;
  const ChunkBounds moving = SegmentParts(Strands(arrays)).exact_bounds(2);
  const ChunkBounds swept = SegmentParts(Strands(arrays)).exact_bounds(1);
  double still_area = 0, moving_area = 0, swept_area = 0;
  for (size_t c = 0; c < still.cell_bounds.count(); ++c) {
    still_area += surface_area(still.cell_bounds.box(c, 0));
    moving_area += surface_area(moving.cell_bounds.box(c, 0.5f));
    swept_area += surface_area(swept.cell_bounds.box(c, 0.5f));
  }
  EXPECT_NEAR(moving_area / still_area, 1, 0.01);
  EXPECT_GT(swept_area / still_area, 2);
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
}  // namespace pelage::segment_parts_test
