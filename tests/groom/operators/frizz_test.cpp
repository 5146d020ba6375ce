// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/frizz.h"

#include "tests/groom/operator_harness.h"

namespace pelage {
namespace {

using FrizzTest = OperatorTest;

TEST_F(FrizzTest, Bounds) {
  check_bounds(prepared<Frizz>({.amplitude = Field(0.02f), .frequency = Field(3.0f)}), {1, 1, 0});
  check_bounds(prepared<Frizz>({.amplitude = Field(0.5f), .frequency = Field(40.0f)}), {1, 1, 0});
}

TEST_F(FrizzTest, NeighboursWanderApart) {
  // Displacements of different strands are independent: their mean product is near zero against their size.
  const Frizz op = prepared<Frizz>({.amplitude = Field(0.1f), .frequency = Field(2.0f)});
  auto batch = straight();
  const StrandBatch before = *batch;
  op.apply(*batch);
  double product = 0, size = 0;
  for (size_t s = 0; s + 1 < batch->count; ++s) {
    // In the frames of the roots, so that the shape of the ball does not matter.
    const V3f a = batch->rest.frame(s).to_local(batch->offset(7, s) - before.offset(7, s));
    const V3f b = batch->rest.frame(s + 1).to_local(batch->offset(7, s + 1) - before.offset(7, s + 1));
    EXPECT_NEAR(a.z, 0, 1e-5f);  // sideways only
    product += a.dot(b);
    size += a.dot(a);
  }
  EXPECT_LT(std::fabs(product), 0.2 * size);
  EXPECT_GT(size / static_cast<double>(batch->count), 0.1 * 0.1 * 0.3);
}

}  // namespace
}  // namespace pelage
