// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/parallel_rays.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

V3f random_point(uint64_t seed) {
  return {signed_float(hash64(seed, 1)), signed_float(hash64(seed, 2)), signed_float(hash64(seed, 3))};
}

TEST(ParallelRays, PassTheSamePiecesAsRaysTestedOneByOne) {
  for (uint64_t seed = 0; seed < 4; ++seed) {
    const V3f direction = random_point(hash64(seed, 4)).normalized();
    std::vector<V3f> origins;
    for (uint64_t i = 0; i < 300; ++i) origins.push_back(random_point(hash64(seed, i, 5)));
    const ParallelRays rays(direction, origins);
    ASSERT_EQ(rays.size(), origins.size());
    int passed = 0;
    for (uint64_t i = 0; i < 50; ++i) {
      const V3f begin = random_point(hash64(seed, i, 6)),
                end = begin + 0.5f * random_point(hash64(seed, i, 7));
      const StrandPiece piece{begin, end, 0.1f, 0.05f, 0};
      std::vector<ParallelRays::Pass> passes;
      rays.meet(piece, 1.5f, passes);
      std::map<uint32_t, ParallelRays::Pass> found;
      for (const auto& pass : passes) EXPECT_TRUE(found.emplace(pass.ray, pass).second) << "twice";
      for (uint32_t r = 0; r < origins.size(); ++r) {
        // The nearest of many places along the piece, across the ray.
        float nearest = 1e9f, along = 0, at = 0;
        for (int step = 0; step <= 500; ++step) {
          const float t = static_cast<float>(step) / 500;
          const V3f off = begin + t * (end - begin) - origins[r];
          const float z = off.dot(direction), across = (off - z * direction).length();
          if (across < nearest) nearest = across, along = z, at = t;
        }
        const float radii = nearest / (0.1f - 0.05f * at);
        if (radii < 1.46f) {
          ASSERT_TRUE(found.count(r)) << seed << " " << i << " " << r;
          // Steps are at most 0.0018 long, and radii at least 0.05.
          EXPECT_NEAR(found.at(r).across, radii, 0.04f);
          EXPECT_NEAR(found.at(r).distance, along, 0.04f);
          ++passed;
        } else if (radii > 1.54f) {
          EXPECT_FALSE(found.count(r));
        }
      }
    }
    EXPECT_GT(passed, 20);
  }
}

TEST(ParallelRays, MayBeNoneOrAllOfOneOrigin) {
  const StrandPiece piece{V3f(-1, 0, 1), V3f(1, 0, 1), 0.1f, 0.1f, 0};
  std::vector<ParallelRays::Pass> passes;
  ParallelRays(V3f(0, 0, 1), {}).meet(piece, 1, passes);
  EXPECT_TRUE(passes.empty());
  const std::vector<V3f> same(5, V3f(0.3f, 0, 0));
  ParallelRays(V3f(0, 0, 1), same).meet(piece, 1, passes);
  EXPECT_EQ(passes.size(), 5u);
  for (const auto& pass : passes) EXPECT_FLOAT_EQ(pass.distance, 1);
}

}  // namespace
}  // namespace pelage
