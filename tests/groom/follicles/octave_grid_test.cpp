// SPDX-License-Identifier: Apache-2.0
#include "groom/follicles/octave_grid.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/groom/operator_harness.h"
#include "tests/support/effort.h"

namespace pelage::octave_grid_test {
namespace {

/// A place whose spacing is between 1 and 2^octaves.
FollicleCandidate random_place(const V3f& middle, float size, float octaves, TestRandom& random) {
  const V3f at = middle + random.direction() * (size * random.unit());
  FollicleCandidate place;
  place.x = at.x;
  place.y = at.y;
  place.z = at.z;
  place.normal = pack_normal(random.direction());
  place.spacing = std::exp2(octaves * random.unit());
  return place;
}

/// The distance as OctaveGrid::nearest() defines it, by looking at all follicles.
float nearest_of_all(const std::vector<FollicleCandidate>& follicles, const FollicleCandidate& candidate,
                     float radius, size_t skipped) {
  float best = radius;
  for (size_t i = skipped; i < follicles.size(); ++i) {
    const FollicleCandidate& other = follicles[i];
    const float dx = candidate.x - other.x, dy = candidate.y - other.y, dz = candidate.z - other.z;
    const float spacing = std::min(candidate.spacing, other.spacing);
    if (unpack_normal(other.normal).dot(unpack_normal(candidate.normal)) < 0.5f) continue;
    best = std::min(best, std::sqrt(dx * dx + dy * dy + dz * dz) / spacing);
  }
  return best;
}

TEST(OctaveGrid, FindsTheNearestFollicleOfAll) {
  TestRandom random(48);
  for (const V3f& middle : {V3f(0), V3f(-700, 30, 4e4f)}) {
    for (const float octaves : {0.0f, 1.0f, 5.0f}) {
      OctaveGrid grid(1, 600);
      std::vector<FollicleCandidate> follicles;
      grid.rebuild(600, 0.5f);
      for (int i = 0; i < 600; ++i) {
        follicles.push_back(random_place(middle, 4, octaves, random));
        grid.insert(follicles.back());
      }
      int exact = 0, stopped = 0;
      for (uint64_t i = 0; i < repetitions(3000); ++i) {
        FollicleCandidate candidate = random_place(middle, 6, octaves, random);
        if (i % 7 == 0) {
          candidate.x = follicles[i % follicles.size()].x;
          candidate.y = follicles[i % follicles.size()].y;
        }
        const float radius = i % 2 == 0 ? 0.5f : 0.2f;
        const uint32_t skipped = i % 3 == 0 ? 250 : 0;
        const float wanted = nearest_of_all(follicles, candidate, radius, skipped);
        const float found = grid.nearest(candidate, radius, skipped);
        if (wanted < 0.6f * radius) {
          // The search may stop at any follicle that is so near.
          ++stopped;
          EXPECT_LT(found, 0.6f * radius) << i;
          EXPECT_GE(found, wanted) << i;
        } else {
          exact += wanted < radius;
          EXPECT_EQ(found, wanted) << i;
        }
      }
      EXPECT_GT(exact, 0);
      EXPECT_GT(stopped, 0);
    }
  }
}

}  // namespace
}  // namespace pelage::octave_grid_test
