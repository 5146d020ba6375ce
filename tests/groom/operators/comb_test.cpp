// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/comb.h"

#include "tests/groom/operator_harness.h"

namespace pelage::comb_test {
namespace {

using CombTest = OperatorTest;

constexpr float kHalfTurn = std::numbers::pi_v<float>;

CombParams params(float lift, float amount, float curve) {
  return {.direction = Field(Rgb(0, -1, 0.2f)), .lift = Field(lift), .amount = Field(amount), .curve = curve};
}

TEST_F(CombTest, Bounds) {
  check_bounds(prepared<Comb>(params(0, 1, 0)), {1.5f, 1.5f, 0, 0, 7});  // standing strands
  check_bounds(prepared<Comb>(params(0.6f, 1, 0)), {1.5f, 1.5f, 0, 0, 7});
  check_bounds(prepared<Comb>(params(0.2f, 0.5f, 0)), {1.5f, 1.5f, 0, 0.5f, 7});  // leaning ones
  check_bounds(prepared<Comb>(params(0, 1, 0.7f)), {1.5f, 1.5f, 0, 0, 7});
  check_bounds(prepared<Comb>(params(0, 1, 0)), {1.5f, 1.5f, 0, kHalfTurn, 7});  // any
}

TEST_F(CombTest, StrandsLieInTheDirectionAtTheLift) {
  const Comb op = prepared<Comb>(params(1.0f / 3, 1, 0));
  auto batch = straight();
  op.apply(*batch);
  for (size_t s = 0; s < batch->count; ++s) {
    const V3f normal = vector_at(batch->rest.normal, s);
    V3f along = V3f(0, -1, 0.2f).normalized();
    along -= normal * normal.dot(along);
    if (along.length() < 0.2f) continue;  // where the direction is normal to the skin
    const V3f chord = batch->offset(7, s).normalized();
    EXPECT_NEAR(std::asin(chord.dot(normal)), kHalfTurn / 6, 1e-3f);
    EXPECT_GT((chord - normal * normal.dot(chord)).normalized().dot(along.normalized()), 0.9999f);
  }
}

TEST_F(CombTest, KeepsLengthsAndRises) {
  const Comb op = prepared<Comb>(params(0, 1, 1));
  auto batch = random_strands({1, 1, 0, 1, 7}, 0, 5);
  const StrandBatch before = *batch;
  op.apply(*batch);
  for (size_t s = 0; s < batch->count; ++s) EXPECT_NEAR(length_of(*batch, s), length_of(before, s), 1e-5f);
  // A strand that turns over its whole length still leaves the skin upwards.
  auto standing = straight();
  op.apply(*standing);
  for (size_t s = 0; s < standing->count; ++s) {
    EXPECT_GT(standing->offset(1, s).normalized().dot(vector_at(standing->rest.normal, s)), 0.95f);
  }
}

}  // namespace
}  // namespace pelage::comb_test
