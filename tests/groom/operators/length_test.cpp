// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/length.h"

#include "tests/groom/operator_harness.h"

namespace pelage {
namespace {

using LengthTest = OperatorTest;

TEST_F(LengthTest, Bounds) {
  check_bounds(prepared<Length>({.value = Field(2.0f), .scale = Field(1.0f), .variation = 0.3f}),
               {1, 1, 0.1f});
  check_bounds(prepared<Length>({.value = Field(0.2f), .scale = Field(1.0f), .variation = 0.5f}),
               {1, 1, 0.1f});
  check_bounds(prepared<Length>({.value = {}, .scale = Field(0.5f), .variation = 0.4f}), {1, 1, 0.1f});
  check_bounds(prepared<Length>({.value = {}, .scale = Field(1.8f), .variation = 0}), {1, 1, 0.1f});
}

TEST_F(LengthTest, StrandsAreAsLongAsAsked) {
  const Length op = prepared<Length>({.value = Field(2.0f), .scale = Field(1.5f), .variation = 0.25f});
  auto batch = random_strands({1, 1, 0}, 0, 3);
  op.apply(*batch);
  float shortest = 10, longest = 0, sum = 0;
  for (size_t s = 0; s < batch->count; ++s) {
    const float length = length_of(*batch, s);
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
    sum += length;
  }
  EXPECT_NEAR(longest, 3.0f, 0.02f);
  EXPECT_NEAR(shortest, 2.25f, 0.02f);
  EXPECT_NEAR(sum / static_cast<float>(batch->count), 2.625f, 0.05f);
}

TEST_F(LengthTest, AddsToTheLength) {
  for (const float add : {0.5f, -0.3f, -2.0f}) {
    const Length op = prepared<Length>({.value = {}, .scale = Field(2.0f), .add = Field(add)});
    check_bounds(op, {0.4f, 0.4f, 0}, add < -1 ? -1.0f : 0.4f);
    auto batch = straight();
    op.apply(*batch);
    for (size_t s = 0; s < batch->count; ++s)
      EXPECT_NEAR(length_of(*batch, s), std::max(0.0f, 2 + add), 1e-5f);
  }
}

}  // namespace
}  // namespace pelage
