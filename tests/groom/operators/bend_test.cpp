// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/bend.h"

#include "tests/groom/operator_harness.h"

namespace pelage {
namespace {

using BendTest = OperatorTest;

BendParams params(float angle, float start, float profile) {
  return {.direction = Field(Rgb(0, -1, 0)),
          .angle = Field(angle),
          .start = start,
          .profile = profile,
          .variation = 0};
}

TEST_F(BendTest, Bounds) {
  check_bounds(prepared<Bend>(params(45, 0, 1)), {1.5f, 1.5f, 0});
  check_bounds(prepared<Bend>(params(120, 0, 1)), {1.5f, 1.5f, 0});
  check_bounds(prepared<Bend>(params(90, 0.5f, 1)), {1.5f, 1.5f, 0, 0.4f, 7});
  check_bounds(prepared<Bend>(params(90, 0, 3)), {1.5f, 1.5f, 0});
  check_bounds(prepared<Bend>(params(60, 0, 0.5f)), {1.5f, 1.5f, 0});
  BendParams half = params(90, 0, 1);
  half.amount = Field(0.5f);
  check_bounds(prepared<Bend>(half), {1.5f, 1.5f, 0, 0.4f, 7});
}

TEST_F(BendTest, BendsTowardsTheDirectionButNotBeyond) {
  const V3f down(0, -1, 0);
  const Bend op = prepared<Bend>(params(60, 0, 1));
  auto batch = straight();
  op.apply(*batch);
  for (size_t s = 0; s < batch->count; ++s) {
    const V3f normal = vector_at(batch->rest.normal, s);
    const float before = std::acos(std::clamp(normal.dot(down), -1.0f, 1.0f));
    const V3f last = (batch->offset(7, s) - batch->offset(6, s)).normalized();
    const float after = std::acos(std::clamp(last.dot(down), -1.0f, 1.0f));
    EXPECT_NEAR(length_of(*batch, s), 1, 1e-5f);
    // The last of seven segments has turned by 13/14 of the angle.
    const float turned = std::min(before, std::numbers::pi_v<float> / 3) * 13 / 14;
    EXPECT_NEAR(after, before - turned, 2e-3f);
  }
}

TEST_F(BendTest, AmountScalesTheAngleAndKeepsLengths) {
  BendParams half = params(90, 0, 1);
  half.amount = Field(0.5f);
  auto a = straight(), b = straight();
  prepared<Bend>(half).apply(*a);
  for (size_t s = 0; s < a->count; ++s) EXPECT_NEAR(length_of(*a, s), 1, 1e-5f);
  half.amount = Field(0.0f);
  prepared<Bend>(half).apply(*b);
  for (size_t s = 0; s < b->count; ++s) EXPECT_EQ(b->offset(7, s), straight()->offset(7, s));
}

}  // namespace
}  // namespace pelage
