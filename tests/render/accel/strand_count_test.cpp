// SPDX-License-Identifier: Apache-2.0
// Accel::strands_crossed().
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "render/accel/crossings.h"
#include "render/accel/embree_query.h"
#include "tests/render/accel/chunk_accel_fixture.h"
#include "tests/support/effort.h"

namespace pelage::strand_count_test {
namespace {

constexpr float kEnd = std::numeric_limits<float>::infinity();

class StrandCountTest : public ChunkAccelTest {
 protected:
  /// The slow truth for opaque strands: one ray after another, each from the last hit on.
  static float hops(const Accel& accel, Ray ray, AccelKind kind, TraceThread& thread) {
    std::set<CrossingPlace> places;
    while (const Hit hit = accel.closest(ray, thread)) {
      if (hit.kind == HitKind::kSkin) return kEnd;
      const uint32_t joint =
          kind == AccelKind::kEmbree ? joint_beside(hit.u, kTessellationRate) : (hit.u > 0.5f ? 1u : 0u);
      places.insert({hit.strand_id, hit.part, hit.segment + joint});
      ray.near = std::nextafter(hit.distance, kEnd);
    }
    return static_cast<float>(places.size());
  }
};

TEST_F(StrandCountTest, IsTheNumberOfHitsOneAfterAnother) {
  const FlushDenormals flush;
  const TestChunks chunks = random_chunks(3, scene_of_kind(0));
  for (const AccelKind kind : kAccelKinds) {
    ResidentChunksOptions options;
    options.kind = kind;
    const auto accel = make(chunks, chunks.bounds(8), options),
               other = make(chunks, chunks.bounds(1), options);
    TraceThread thread;
    uint64_t several = 0, blocked = 0, differing = 0;
    const uint64_t rays = repetitions(3000);
    for (uint64_t i = 0; i < rays; ++i) {
      const Ray ray = inner_ray(3, i);
      const StrandCount count = accel->strands_crossed(ray, 100, thread);
      // Two strands at the same distance are one hop.
      differing += count.strands != hops(*accel, ray, kind, thread);
      ASSERT_EQ(count.strands, other->strands_crossed(ray, 100, thread).strands) << i;
      ASSERT_EQ(count.through, count.strands == 0 ? 1 : 0) << i;
      several += count.strands > 1 && count.strands < kEnd;
      blocked += count.strands == kEnd;
      if (count.strands == kEnd) continue;
      const StrandCount two = accel->strands_crossed(ray, 2, thread);
      ASSERT_EQ(two.strands, count.strands > 2 ? kEnd : count.strands) << i;
    }
    EXPECT_LE(differing, rays / 1000);
    EXPECT_GT(several, rays / 50);
    EXPECT_GT(blocked, 0);
  }
}

TEST_F(StrandCountTest, SumsUpOpacities) {
  const FlushDenormals flush;
  const TestChunks chunks = random_chunks(5, scene_of_kind(1));
  const auto accel = make(chunks, chunks.bounds(8));
  TraceThread thread;
  uint64_t partly = 0;
  for (uint64_t i = 0; i < repetitions(3000); ++i) {
    const Ray ray = inner_ray(5, i);
    const float through = accel->transmittance(ray, thread);
    const StrandCount count = accel->strands_crossed(ray, 100, thread);
    ASSERT_EQ(count.through, through) << i;
    if (!(through > 0 && through < 1)) continue;
    ++partly;
    // 1 - o <= exp(-o).
    ASSERT_LE(through, std::exp(-count.strands) * 1.0001f) << i;
  }
  EXPECT_GT(partly, 0);
}

CrossingPlace crossing(uint32_t strand) { return {strand, 0, 0}; }

TEST(CountedCrossings, AnswerTheSameInEveryOrder) {
  // The crossing with strand 1 is reported twice, and strand 2 is the one that is too many.
  std::vector<std::pair<uint32_t, float>> reports{{1, 0.99f}, {1, 1.0f}, {2, 0.5f}};
  std::sort(reports.begin(), reports.end());
  do {
    Crossings crossings(1);
    for (const auto& [strand, opacity] : reports) crossings.count(crossing(strand), opacity);
    EXPECT_EQ(crossings.total().strands, kEnd);
    EXPECT_EQ(crossings.total().through, 0);
  } while (std::next_permutation(reports.begin(), reports.end()));
}

TEST(CountedCrossings, EndSoonWhereStrandsAreThin) {
  Crossings crossings(4);
  uint32_t strands = 0;
  while (strands < 10000 && crossings.count(crossing(strands), 0.05f)) ++strands;
  EXPECT_GE(strands, 80);  // the sum of their opacities exceeds 4
  EXPECT_LE(strands, 100);
  EXPECT_EQ(crossings.total().strands, kEnd);
}

TEST(CountedCrossings, KeepLightThatStillArrives) {
  Crossings crossings(1);
  float through = 1;
  for (uint32_t strand = 0; strand < 15; ++strand) {
    EXPECT_TRUE(crossings.count(crossing(strand), 0.1f));
    through *= 0.9f;
  }
  EXPECT_EQ(crossings.total().through, through);
}

}  // namespace
}  // namespace pelage::strand_count_test
