// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/fit_coverage.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "procedurals/detail/coat_stats.h"
#include "procedurals/detail/parallel_rays.h"
#include "tests/procedurals/square_groom.h"

namespace pelage {
namespace {

constexpr uint32_t kStrands = 2000;

/// Straight strands of a square, in groups of `together` within three strand widths.
std::shared_ptr<const Groom> meadow(MemoryLedger& ledger, uint32_t together, int leaf_strands) {
  StrandArrays a;
  a.first_point = {0};
  constexpr float kRadius = 0.003f;
  for (uint32_t s = 0; s < kStrands; ++s) {
    const uint32_t group = s / together;
    const V3f middle(signed_float(hash64(group, 1)), signed_float(hash64(group, 2)), 0);
    const V3f root = middle + 6 * kRadius * V3f(signed_float(hash64(s, 3)), signed_float(hash64(s, 4)), 0);
    for (uint32_t p = 0; p < 4; ++p) {
      const V3f at = root + V3f(0, 0, 0.2f * static_cast<float>(p));
      a.points.insert(a.points.end(), {at.x, at.y, at.z, kRadius});
    }
    a.first_point.push_back(4 * (s + 1));
    a.ids.push_back(s);
  }
  return groom_of(ledger, std::move(a), leaf_strands);
}

std::optional<WidthFit> fit(const Groom& groom, MemoryLedger& ledger, int threads, bool even = true) {
  const Workers workers(threads);
  NoProgress progress;
  const EvenPriorities priorities(groom, ledger);
  const Simplification seen({}, LodView(), coat_stats(groom, nullptr, workers), 1);
  return fit_coverage(groom, nullptr, even ? &priorities : nullptr, seen, 2 / std::sqrt(float(kStrands)),
                      Job{workers, ledger, progress});
}

TEST(FitCoverage, KeepsTheWidthsOfIndependentStrandsAndNarrowsThoseOfClumps) {
  MemoryLedger ledger;
  const auto ones = meadow(ledger, 1, 8000), clumps = meadow(ledger, 16, 8000);
  const auto random = fit(*ones, ledger, 2, false), even = fit(*ones, ledger, 2),
             clumped = fit(*clumps, ledger, 2);
  ASSERT_TRUE(random && even && clumped);
  // Of 500 strands kept at random, the number before a ray varies by 4.5 %: two standard deviations.
  EXPECT_NEAR(random->at(0.25f), 1, 0.09f);
  // Four strands four times as wide, in a clump 12 radii across, cover more than sixteen.
  EXPECT_LT(clumped->at(0.25f), even->at(0.25f) - 0.05f);
  EXPECT_LT(clumped->at(1 / 16.0f), clumped->at(0.25f));
}

TEST(FitCoverage, DependsOnNeitherLeavesNorThreads) {
  MemoryLedger ledger;
  const auto whole = fit(*meadow(ledger, 16, 8000), ledger, 1);
  ASSERT_TRUE(whole);
  EXPECT_EQ(fit(*meadow(ledger, 16, 111), ledger, 3)->factors, whole->factors);
}

TEST(FitCoverage, ChargesItsStrandsAndRaysWhileItRuns) {
  MemoryLedger grooms, ledger;
  NoProgress progress;
  const Workers workers(1);
  const auto groom = meadow(grooms, 1, 8000);
  const Simplification seen({}, LodView(), coat_stats(*groom, nullptr, workers), 1);
  fit_coverage(*groom, nullptr, nullptr, seen, 2 / std::sqrt(float(kStrands)),
               Job{workers, ledger, progress});
  // All strands of three segments are around a root in the middle of the square, and half that far around
  // starts a quarter of the rays: two per strand and direction.
  constexpr int64_t kPieces = kStrands * 3 * sizeof(StrandPiece), kRays = kStrands / 4 * 2 * 8 / 2 * 28;
  EXPECT_GT(ledger.peak(MemoryTag::kGrooms), kPieces / 2 + kRays / 2);
  EXPECT_LT(ledger.peak(MemoryTag::kGrooms), 8 * (kPieces + kRays));
  EXPECT_EQ(ledger.current(MemoryTag::kGrooms), 0);
}

TEST(FitCoverage, OfShortStrandsThatNeverMeetIsUnknown) {
  MemoryLedger ledger;
  EXPECT_FALSE(fit(*grown_on_a_square(ledger, kStrands, 8000), ledger, 2));
}

}  // namespace
}  // namespace pelage
