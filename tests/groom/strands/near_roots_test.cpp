// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/near_roots.h"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tests/groom/operator_harness.h"
#include "tests/support/effort.h"

namespace pelage::near_roots_test {

/// The `wanted` nearest places as RootGrid::nearest_if() defines them, by looking at all places.
template <class Accept>
std::vector<RootGrid::Neighbour> nearest_of_all(const RootGrid& grid, const V3f& position, const V3f& normal,
                                                int wanted, const Accept& accept) {
  std::vector<RootGrid::Neighbour> all;
  for (uint32_t i = 0; i < grid.size(); ++i) {
    const V3f d = grid.position(i) - position;
    const float distance2 = d.dot(d);
    if (distance2 > grid.radius() * grid.radius()) continue;
    if (RootGrid::same_side(grid.normal(i), normal) && accept(i)) all.push_back({i, std::sqrt(distance2)});
  }
  std::sort(all.begin(), all.end(), RootGrid::before);
  all.resize(std::min(all.size(), static_cast<size_t>(wanted)));
  return all;
}

TEST(NearRoots, FindsTheNearestPlacesOfAll) {
  TestRandom random(48);
  const auto some = [](uint32_t i) { return i % 7 != 0; };
  for (const V3f& middle : {V3f(0), V3f(-3, 500, 2e4f)}) {
    for (const float radius : {0.1f, 0.5f, 3.0f}) {
      std::vector<V3f> positions, normals;
      for (size_t i = 0; i < 900; ++i) {
        // Every fourth place coincides with an earlier one, so that distances are equal.
        positions.push_back(i % 4 == 3 ? positions[i / 2] : middle + random.direction() * random.unit());
        normals.push_back((V3f(0, 0, 1) + random.direction() * 0.9f).normalized());
      }
      const RootGrid grid(positions, normals, radius);
      for (uint64_t cluster = 0; cluster < repetitions(60); ++cluster) {
        const int wanted = 1 + static_cast<int>(cluster % 9);
        const size_t count = 1 + cluster % 30;
        const float spread = cluster % 3 == 0 ? 0.01f : 0.1f * random.unit();
        const V3f at = middle + random.direction() * (1.2f * random.unit());
        const auto batch = std::make_unique<RootRows>();
        for (size_t s = 0; s < count; ++s) {
          set_vector(batch->position, s, at + random.direction() * spread);
          set_vector(batch->normal, s, (V3f(0, 0, 1) + random.direction() * 0.5f).normalized());
        }
        NearRoots near(grid, wanted);
        near.collect(*batch, count);
        for (size_t s = 0; s < count; ++s) {
          const V3f position = vector_at(batch->position, s), normal = vector_at(batch->normal, s);
          RootGrid::Neighbour found[9], in_grid[9];
          const auto expected = nearest_of_all(grid, position, normal, wanted, some);
          ASSERT_EQ(near.nearest_if(position, normal, found, some), static_cast<int>(expected.size()));
          ASSERT_EQ(grid.nearest_if(position, normal, wanted, in_grid, some),
                    static_cast<int>(expected.size()));
          for (size_t k = 0; k < expected.size(); ++k) {
            EXPECT_EQ(found[k].index, expected[k].index);
            EXPECT_EQ(found[k].distance, expected[k].distance);
            EXPECT_EQ(in_grid[k].index, expected[k].index);
            EXPECT_EQ(in_grid[k].distance, expected[k].distance);
          }
        }
      }
    }
  }
}

}  // namespace pelage::near_roots_test
