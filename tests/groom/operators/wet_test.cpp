// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/wet.h"

#include "tests/groom/operator_harness.h"

namespace pelage::wet_test {
namespace {

class WetTest : public OperatorTest {};

TEST_F(WetTest, Bounds) {
  check_bounds(prepared<Wet>(WetParams{}), {0.8f, 0.8f, 0, 1.0f}, 0.5f);
  WetParams soaked;
  soaked.gather = Field(1.0f);
  soaked.weight = Field(120.0f);
  soaked.flatten = Field(1.0f);
  check_bounds(prepared<Wet>(soaked), {0.8f, 0.8f, 0}, 0.5f);
}

TEST_F(WetTest, StrandsLieDownAndGather) {
  WetParams params;
  params.gather = Field(0.0f);
  auto wet = straight(), gathered = straight();
  const Wet loose = prepared<Wet>(params);
  params.gather = Field(1.0f);
  const Wet tight = prepared<Wet>(params);
  loose.apply(*wet);
  tight.apply(*gathered);
  double apart = 0, before_apart = 0;
  for (size_t s = 0; s < wet->count; ++s) {
    const V3f normal = vector_at(wet->rest.normal, s);
    EXPECT_NEAR(length_of(*wet, s), 1, 1e-5f);
    EXPECT_LE(length_of(*gathered, s), 1.3f);
    EXPECT_GT(wet->offset(7, s).dot(normal), -1e-3f) << "bent into the skin";
    for (size_t t = 0; t < s; ++t) {
      if (gathered->clump[s] != gathered->clump[t]) continue;
      const V3f roots = vector_at(wet->rest.position, s) - vector_at(wet->rest.position, t);
      apart += (gathered->offset(7, s) - gathered->offset(7, t) + roots).length();
      before_apart += (wet->offset(7, s) - wet->offset(7, t) + roots).length();
    }
  }
  EXPECT_LT(apart, 0.5 * before_apart);
}

TEST_F(WetTest, StrandsOnTheSidesHangDown) {
  WetParams params;
  params.gather = Field(0.0f);
  const Wet op = prepared<Wet>(params);
  for (size_t first = 0; first < follicles_.size(); first += kBlockStrands) {
    auto batch = straight(first);
    op.apply(*batch);
    for (size_t s = 0; s < batch->count; ++s) {
      const V3f normal = vector_at(batch->rest.normal, s);
      if (std::abs(normal.y) < 0.5f) {
        EXPECT_LT(batch->offset(7, s).y, normal.y - 0.2f) << normal;
      }
    }
  }
}

TEST_F(WetTest, AmountZeroChangesNoShape) {
  WetParams params;
  params.amount = Field(0.0f);
  auto batch = straight();
  prepared<Wet>(params).apply(*batch);
  for (size_t s = 0; s < batch->count; ++s)
    EXPECT_LT((batch->offset(7, s) - straight()->offset(7, s)).length(), 1e-6f);
}

}  // namespace
}  // namespace pelage::wet_test
