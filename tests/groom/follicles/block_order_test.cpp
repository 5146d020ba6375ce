// SPDX-License-Identifier: Apache-2.0
#include "groom/follicles/block_order.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "groom/follicles/candidate_blocks.h"
#include "groom/follicles/keyed_sort.h"
#include "groom/follicles/progressive_order.h"
#include "tests/groom/operator_harness.h"
#include "tests/groom/scene_text.h"
#include "tests/groom/shapes.h"
#include "tests/support/effort.h"
#include "tests/support/quiet_job.h"

namespace pelage::block_order_test {
namespace {

ControlMesh scaled(float x, float y, float z) {
  ControlMesh cage = shapes::ball_cage();
  for (V3f& p : cage.positions) p = {p.x * x, p.y * y, p.z * z};
  return cage;
}

/// The order of a coat, with candidates in blocks or one by one.
std::optional<std::vector<uint32_t>> order_of(const ControlMesh& cage, const char* density, size_t count,
                                              int threads, bool in_blocks) {
  const auto rest = shapes::surface_of(cage);
  const FollicleDensity field{scene_text::read<Field>(density), {}};
  QuietJob job(threads);
  const SurfaceMeasure measure = measure_surface(*rest, field, job);
  const FollicleCandidates source(*rest, field, 7, count * kCandidatesPerFollicle, measure);
  CandidateSupply supply(source, 1, job);
  return progressive_order(supply, count, measure.mass, {1, supply.survey().count, in_blocks}, job);
}

// Looking at all follicles in a grid, one candidate after the other, is the slow truth.
TEST(BlockOrder, IsThatOfCandidatesOneByOne) {
  const char* densities[] = {"1", "{ramp: {along: y, knots: [[-1, 0.01], [1, 1]]}}",
                             "{ramp: {along: x, knots: [[-1, 0], [-0.5, 0.0001], [1, 1]]}}"};
  for (const char* density : densities) {
    for (const ControlMesh& cage : {shapes::square_cage(5), shapes::ball_cage(), scaled(1, 1, 0.0005f),
                                    scaled(1e-4f, 1e-4f, 1e-4f), scaled(1, 0.03f, 0.03f)}) {
      for (const size_t count : {1, 30, static_cast<int>(repetitions(9000))}) {
        const auto truth = order_of(cage, density, count, 2, false);
        ASSERT_TRUE(truth.has_value());
        EXPECT_EQ(order_of(cage, density, count, 1, true), truth) << count;
        EXPECT_EQ(order_of(cage, density, count, 2, true), truth) << count;
      }
    }
  }
}

TEST(BlockOrder, IsThatOfALargeCoat) {
  const char* density = "{ramp: {along: y, knots: [[-1, 0.05], [1, 1]]}}";
  const size_t count = repetitions(150'000);
  EXPECT_EQ(order_of(shapes::ball_cage(), density, count, 2, true),
            order_of(shapes::ball_cage(), density, count, 2, false));
}

TEST(BlockOrder, UsesAllCandidatesIfNecessary) {
  const auto rest = shapes::surface_of(shapes::square_cage(2));
  const FollicleDensity even{Field(1.0f), {}};
  QuietJob job(2);
  const FollicleCandidates source(*rest, even, 7, 300, measure_surface(*rest, even, job));
  CandidateSupply supply(source, 1, job);
  const size_t all = supply.survey().count;
  const auto order = progressive_order(supply, 10 * all, 1, HeldCandidates::all(all), job);
  // Candidates at the same place, if there are any, are left to the other method.
  ASSERT_TRUE(order.has_value());
  EXPECT_EQ(order->size(), all);
}

/// A place whose spacing is between 1 and 4.
FollicleCandidate random_place(float size, TestRandom& random) {
  const V3f at = V3f(30, -2, 5) + random.direction() * (size * random.unit());
  return {at.x, at.y, at.z, pack_normal(random.direction()), std::exp2(2 * random.unit()), 0, 0};
}

/// The distance as NearFollicles::nearest() defines it, by looking at all follicles.
float nearest_of_all(const std::vector<FollicleCandidate>& follicles, const FollicleCandidate& candidate,
                     float radius, size_t first) {
  float best = radius;
  for (size_t i = first; i < follicles.size(); ++i) {
    const FollicleCandidate& other = follicles[i];
    const float dx = candidate.x - other.x, dy = candidate.y - other.y, dz = candidate.z - other.z;
    if (unpack_normal(other.normal).dot(unpack_normal(candidate.normal)) < 0.5f) continue;
    best =
        std::min(best, std::sqrt(dx * dx + dy * dy + dz * dz) / std::min(candidate.spacing, other.spacing));
  }
  return best;
}

TEST(CandidateBlocks, ListEveryFollicleThatIsNear) {
  TestRandom random(52);
  std::vector<FollicleCandidate> candidates;
  for (int i = 0; i < 3000; ++i) candidates.push_back(random_place(3, random));
  std::sort(candidates.begin(), candidates.end(),
            [](const FollicleCandidate& a, const FollicleCandidate& b) { return a.x < b.x; });
  CandidateBlocks blocks(candidates, 900, 1 << 20);
  std::vector<FollicleCandidate> follicles;
  NearFollicles near, all;
  int found = 0;
  for (const float radius : {1.0f, 0.5f, 0.2f}) {
    const uint32_t earlier = blocks.follicle_count();
    for (int i = 0; i < 300; ++i) {
      follicles.push_back(random_place(4, random));
      ASSERT_TRUE(blocks.add(follicles.back(), radius));
    }
    for (size_t c = 0; c < candidates.size(); ++c) {
      const size_t block = c / CandidateBlocks::kBlock;
      if (c % CandidateBlocks::kBlock == 0) {
        blocks.gather_all(block, all);
        blocks.gather(block, radius, near);
      }
      const float truth = nearest_of_all(follicles, candidates[c], radius, 0);
      EXPECT_EQ(near.nearest(candidates[c], radius), truth);
      EXPECT_EQ(all.nearest(candidates[c], radius), truth);
      EXPECT_EQ(blocks.nearest_of_latest(block, candidates[c], radius, earlier),
                nearest_of_all(follicles, candidates[c], radius, earlier));
      found += truth < radius;
    }
  }
  EXPECT_GT(found, 1000);
}

TEST(KeyedSort, SortsStablyAndArranges) {
  TestRandom random(54);
  std::vector<SortItem> items(5000);
  std::vector<uint32_t> elements;
  for (uint32_t i = 0; i < items.size(); ++i) {
    items[i] = {static_cast<uint32_t>(random.unit() * 1000) << 20, i};
    elements.push_back(items[i].key + i);
  }
  std::vector<SortItem> truth = items;
  std::stable_sort(truth.begin(), truth.end(),
                   [](const SortItem& a, const SortItem& b) { return a.key < b.key; });
  sort_by_key(items, 32, QuietJob(1));
  arrange(elements, items);
  for (size_t i = 0; i < truth.size(); ++i) ASSERT_EQ(elements[i], truth[i].key + truth[i].index) << i;
}

TEST(CandidateBlocks, HaveNoRoomForTooManyEntries) {
  TestRandom random(53);
  std::vector<FollicleCandidate> candidates;
  for (int i = 0; i < 500; ++i) candidates.push_back(random_place(1, random));
  CandidateBlocks blocks(candidates, 100, 200);
  int added = 0;
  while (added < 100 && blocks.add(random_place(1, random), 10)) ++added;
  EXPECT_GE(added, 16);
  EXPECT_LT(added, 100);
}

}  // namespace
}  // namespace pelage::block_order_test
