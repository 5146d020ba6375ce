// SPDX-License-Identifier: Apache-2.0
#include "render/accel/chunk_tree.h"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "base/parallel.h"

namespace pelage::chunk_tree_test {
namespace {

float number(uint64_t a, uint64_t b) { return signed_float(hash64(a, b, random_use("tree test"))); }
V3f vector(uint64_t a, uint64_t b) { return {number(a, 3 * b), number(a, 3 * b + 1), number(a, 3 * b + 2)}; }

/// Chunks of a few boxes each, of very different sizes, some of them flat or without extent.
std::vector<ChunkBounds> random_bounds(uint64_t seed, size_t count, bool moving) {
  std::vector<ChunkBounds> bounds(count);
  for (uint64_t c = 0; c < count; ++c) {
    bounds[c].keys = moving && c % 3 != 0 ? 2 : 1;
    const V3f place = 10.0f * vector(hash64(seed, c), 0);
    for (uint64_t p = 0; p < c % 5; ++p) {
      for (int key = 0; key < bounds[c].keys; ++key) {
        const auto k = static_cast<uint64_t>(key);
        const V3f middle = place + vector(hash64(seed, c, p, k), 1);
        V3f half = vector(hash64(seed, c, p, k), 2);
        half = {std::abs(half.x), std::abs(half.y), c % 7 == 0 ? 0 : std::abs(half.z)};
        if (c % 11 == 0) half *= 1e-4f;
        bounds[c].boxes.push_back(Box3f(middle - half, middle + half));
      }
    }
  }
  return bounds;
}

Box3f box_at(const ChunkBounds& chunk, size_t part, float time) {
  const Box3f &open = chunk.box(part, 0), &close = chunk.box(part, chunk.keys - 1);
  return {(1 - time) * open.min + time * close.min, (1 - time) * open.max + time * close.max};
}

/// Chunks that a walk reports, with their first entries.
std::map<uint32_t, float> walk(const ChunkTree& tree, const Ray& ray, ChunkWalk::Order order) {
  ChunkWalk walk(tree, ray, order);
  std::map<uint32_t, float> met;
  uint32_t chunk = 0;
  float entry = 0;
  while (walk.next(ray.far, chunk, entry)) {
    const auto [place, first] = met.emplace(chunk, entry);
    if (!first) place->second = std::min(place->second, entry);
  }
  return met;
}

/// Whether the ray passes the box when that is enlarged by `margin`; in double precision.
bool meets(const Box3f& box, const Ray& ray, double margin) {
  double enter = ray.near, leave = ray.far;
  for (int i = 0; i < 3; ++i) {
    const double low = box.min[i] - margin - ray.origin[i], high = box.max[i] + margin - ray.origin[i];
    if (ray.direction[i] == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const double a = low / ray.direction[i], b = high / ray.direction[i];
    enter = std::max(enter, std::min(a, b) - margin);
    leave = std::min(leave, std::max(a, b) + margin);
  }
  return enter <= leave;
}

class ChunkTreeTest : public testing::TestWithParam<bool> {};

TEST_P(ChunkTreeTest, FindsEveryChunkThatARayMeetsAndFewOthers) {
  const std::vector<ChunkBounds> bounds = random_bounds(1, 400, GetParam());
  const ChunkTree tree(bounds, Workers(2));
  for (uint64_t i = 0; i < 3000; ++i) {
    // Towards a point of a box, from anywhere; often along an axis.
    const uint64_t word = hash64(i, 5);
    const size_t chunk = word % bounds.size();
    if (bounds[chunk].boxes.empty()) continue;
    Ray ray;
    ray.time = 0.5f * (number(i, 99) + 1);
    const size_t part = (word >> 32) % bounds[chunk].part_count();
    const Box3f box = box_at(bounds[chunk], part, ray.time);
    const V3f corner = box.min + 0.5f * (vector(i, 40) + V3f(1)) * box.size();
    const float reach = i % 3 == 0 ? 1e3f : 5.0f;
    if (i % 4 == 0) {
      V3f along(0);
      along[static_cast<int>(i / 4 % 3)] = i % 8 == 0 ? 1.0f : -1.0f;
      ray.direction = along;
      ray.origin = corner - reach * along;
    } else {
      ray.origin = corner + reach * vector(i, 50);
      ray.direction = (corner - ray.origin).normalized();
    }
    const float distance = (corner - ray.origin).length();
    if (i % 5 == 0) ray.far = 1.0001f * distance + 1e-3f;
    const auto met = walk(tree, ray, ChunkWalk::Order::kFrontToBack);
    const double margin = 4e-6 * (reach + 12);
    for (uint32_t c = 0; c < bounds.size(); ++c) {
      bool must = false, may = false;
      for (size_t p = 0; p < bounds[c].part_count(); ++p) {
        must |= meets(box_at(bounds[c], p, ray.time), ray, 0);
        may |= meets(box_at(bounds[c], p, ray.time), ray, margin);
      }
      const bool found = met.count(c) > 0;
      ASSERT_TRUE(found || !must) << i << " " << c;
      ASSERT_TRUE(may || !found) << i << " " << c;
    }
    ASSERT_LE(met.at(static_cast<uint32_t>(chunk)), distance * (1 + 1e-5f)) << i;
    EXPECT_EQ(met, walk(tree, ray, ChunkWalk::Order::kLongestFirst));
  }
}

INSTANTIATE_TEST_SUITE_P(StillAndMoving, ChunkTreeTest, testing::Bool());

TEST(ChunkTree, GoesFrontToBackWhereBoxesAreApart) {
  std::vector<ChunkBounds> bounds;
  for (int i = 0; i < 100; ++i) {
    const V3f low(0, 0, static_cast<float>(hash64(i) % 100000));
    bounds.push_back({1, {Box3f(low, low + V3f(1, 1, 0.5f))}});
  }
  const ChunkTree tree(bounds, Workers(1));
  Ray ray;
  ray.origin = {0.5f, 0.5f, -1};
  ChunkWalk walk(tree, ray, ChunkWalk::Order::kFrontToBack);
  uint32_t chunk = 0;
  float entry = 0, last = 0;
  size_t count = 0;
  while (walk.next(1e9f, chunk, entry)) {
    EXPECT_GE(entry, last);
    last = entry;
    ++count;
  }
  EXPECT_EQ(count, bounds.size());
}

TEST(ChunkTree, StandsManyEqualBoxes) {
  std::vector<ChunkBounds> bounds(20000, ChunkBounds{1, {Box3f(V3f(-1), V3f(1))}});
  const ChunkTree tree(bounds, Workers(2));
  Ray ray;
  ray.origin = {0, 0, -5};
  EXPECT_EQ(walk(tree, ray, ChunkWalk::Order::kFrontToBack).size(), bounds.size());
}

TEST(ChunkTree, StandsSizesOfEveryScale) {
  // Boxes that halve in size again and again make the deepest tree that surface area can ask for.
  std::vector<ChunkBounds> bounds;
  float size = 1e18f;
  for (int i = 0; i < 120; ++i, size *= 0.5f) bounds.push_back({1, {Box3f(V3f(size), V3f(1.5f * size))}});
  const ChunkTree tree(bounds, Workers(2));
  Ray ray;
  ray.direction = V3f(1).normalized();
  EXPECT_EQ(walk(tree, ray, ChunkWalk::Order::kFrontToBack).size(), bounds.size());
}

TEST(ChunkTree, IsTheSameForAnyNumberOfThreads) {
  const std::vector<ChunkBounds> bounds = random_bounds(3, 9000, true);
  const ChunkTree one(bounds, Workers(1)), four(bounds, Workers(4));
  EXPECT_EQ(one.bytes(), four.bytes());
  for (uint64_t i = 0; i < 300; ++i) {
    Ray ray;
    ray.origin = 20.0f * vector(i, 1);
    ray.direction = (10.0f * vector(i, 2) - ray.origin).normalized();
    ray.time = 0.3f;
    ChunkWalk a(one, ray, ChunkWalk::Order::kFrontToBack), b(four, ray, ChunkWalk::Order::kFrontToBack);
    uint32_t chunk_a = 0, chunk_b = 0;
    float entry_a = 0, entry_b = 0;
    while (a.next(1e9f, chunk_a, entry_a)) {
      ASSERT_TRUE(b.next(1e9f, chunk_b, entry_b));
      ASSERT_EQ(chunk_a, chunk_b);
      ASSERT_EQ(entry_a, entry_b);
    }
    ASSERT_FALSE(b.next(1e9f, chunk_b, entry_b));
    EXPECT_EQ(a.box_tests(), b.box_tests());
  }
}

TEST(ChunkTree, HoldsNothingWhereNothingIs) {
  const ChunkTree none({}, Workers(1));
  EXPECT_TRUE(none.bounds().isEmpty());
  EXPECT_TRUE(walk(none, Ray(), ChunkWalk::Order::kFrontToBack).empty());
  const std::vector<ChunkBounds> hollow(5, ChunkBounds{1, {Box3f()}});
  EXPECT_TRUE(walk(ChunkTree(hollow, Workers(1)), Ray(), ChunkWalk::Order::kFrontToBack).empty());
}

}  // namespace
}  // namespace pelage::chunk_tree_test
