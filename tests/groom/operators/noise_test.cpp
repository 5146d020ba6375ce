// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/noise.h"

#include "tests/groom/operator_harness.h"

namespace pelage {
namespace {

using NoiseTest = OperatorTest;

TEST_F(NoiseTest, Bounds) {
  check_bounds(prepared<Noise>({.amplitude = Field(0.3f), .frequency = 5, .along = 1, .profile = 1}),
               {1, 1, 0});
}

TEST_F(NoiseTest, NeighboursMoveTogether) {
  const Noise op = prepared<Noise>({.amplitude = Field(0.3f), .frequency = 1, .along = 1, .profile = 1});
  auto batch = straight(0, 8, kBlockStrands);
  const StrandBatch before = *batch;
  op.apply(*batch);
  int pairs = 0;
  for (size_t s = 0; s < batch->count; ++s) {
    for (size_t t = 0; t < s; ++t) {
      const float apart = (vector_at(batch->rest.position, s) - vector_at(batch->rest.position, t)).length();
      if (apart > 0.06f) continue;
      const V3f difference =
          (batch->offset(7, s) - before.offset(7, s)) - (batch->offset(7, t) - before.offset(7, t));
      EXPECT_LT(difference.length(),
                0.3f * 4 * apart);  // noise of frequency 1 changes by a few times the distance
      ++pairs;
    }
  }
  EXPECT_GT(pairs, 10);
}

}  // namespace
}  // namespace pelage
