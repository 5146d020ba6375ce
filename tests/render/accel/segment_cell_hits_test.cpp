// SPDX-License-Identifier: Apache-2.0
#include "render/accel/segment_cell_hits.h"

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

float number(uint64_t seed, uint64_t use) { return signed_float(hash64(seed, use, random_use("gate"))); }

V3f vector(uint64_t seed, uint64_t use) {
  return {number(seed, 3 * use), number(seed, 3 * use + 1), number(seed, 3 * use + 2)};
}

/// Where the ray enters the box when that is enlarged by `margin`, in double precision; infinity when it does
/// not.
double enter_box(const Box3f& box, const Ray& ray, double margin) {
  double enter = ray.near, leave = ray.far;
  for (int i = 0; i < 3; ++i) {
    const double low = box.min[i] - margin - ray.origin[i], high = box.max[i] + margin - ray.origin[i];
    if (ray.direction[i] == 0) {
      if (low > 0 || high < 0) return INFINITY;
      continue;
    }
    const double a = low / ray.direction[i], b = high / ray.direction[i];
    enter = std::max(enter, std::min(a, b) - margin);
    leave = std::min(leave, std::max(a, b) + margin);
  }
  return enter <= leave ? enter : INFINITY;
}

class SegmentCellHitsTest : public testing::TestWithParam<int> {};

// The slow truth beside it: each box by itself.
TEST_P(SegmentCellHitsTest, IsPassedAsItsBoxesAreOneByOne) {
  const auto count = static_cast<size_t>(GetParam());
  const float distance = GetParam() % 2 == 0 ? 0.0f : 300.0f;
  const V3f place = distance * vector(count, 9);
  std::vector<Box3f> given;
  for (size_t b = 0; b < count; ++b) {
    const V3f middle = vector(hash64(count, b), 1), moved = middle + V3f(0.5f, 0.1f, 0) + 0.1f * vector(b, 2);
    V3f half = 0.05f * vector(hash64(count, b), 3);
    for (int i = 0; i < 3; ++i) half[i] = std::abs(half[i]);
    given.push_back({place + middle - half, place + middle + half});
    given.push_back({place + moved - half, place + moved + half});
  }
  const SegmentCellBounds boxes(given, 2);
  const float reach = distance + 2;
  uint64_t met = 0, missed = 0;
  for (uint64_t i = 0; i < 3000; ++i) {
    Ray ray;
    ray.time = 0.5f * (number(i, 1) + 1);
    const float away = i % 3 == 0 ? 0.5f : 20.0f;
    const size_t near = i % count;  // half of the rays are sent towards a box
    const V3f target = i % 2 == 0 ? place + vector(i, 2) : boxes.box(near, ray.time).center();
    if (i % 4 == 0) {
      V3f along(0);
      along[static_cast<int>(i / 4 % 3)] = i % 8 == 0 ? 1.0f : -1.0f;
      ray.direction = along;
      ray.origin = target - away * along;
    } else {
      ray.origin = target + away * vector(i, 3);
      ray.direction = (target - ray.origin).normalized();
    }
    if (i % 5 == 0) ray.far = 0.5f * away;
    const double margin = 4e-6 * (away + reach + distance);
    double first = INFINITY, loose = INFINITY;
    uint32_t surely = 0, perhaps = 0;
    for (size_t b = 0; b < count; ++b) {
      const double inner = enter_box(boxes.box(b, ray.time), ray, -margin);
      const double outer = enter_box(boxes.box(b, ray.time), ray, margin);
      first = std::min(first, inner);
      loose = std::min(loose, outer);
      surely += inner < INFINITY;
      perhaps += outer < INFINITY;
    }
    int64_t tests = 0, all_tests = 0;
    const SegmentCellHits first_met =
        intersect_segment_cell_bounds(boxes, RaySlabs(ray, reach), ray.far, false, tests);
    const SegmentCellHits all_met =
        intersect_segment_cell_bounds(boxes, RaySlabs(ray, reach), ray.far, true, all_tests);
    const float enter = first_met.entry;
    ASSERT_EQ(enter, all_met.entry) << i;
    ASSERT_GE(all_met.boxes, surely) << i;
    ASSERT_LE(all_met.boxes, perhaps) << i;
    EXPECT_LE(tests, all_tests);
    ASSERT_LE(enter, first) << i;
    ASSERT_GE(enter, loose) << i;
    EXPECT_GT(tests, 0);
    met += enter < INFINITY;
    missed += enter == INFINITY;
  }
  EXPECT_GT(met, 20u);
  EXPECT_GT(missed, 20u);
}

INSTANTIATE_TEST_SUITE_P(Boxes, SegmentCellHitsTest, testing::Values(1, 4, 5, 37, 64, 175, 500));

TEST(SegmentCellHitsTest, NothingIsMetWhereThereAreNoBoxes) {
  int64_t tests = 0;
  EXPECT_EQ(intersect_segment_cell_bounds(SegmentCellBounds(), RaySlabs(Ray(), 1), 1e9f, false, tests).entry,
            INFINITY);
  EXPECT_EQ(tests, 0);
}

}  // namespace
}  // namespace pelage
