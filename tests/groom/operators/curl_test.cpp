// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/curl.h"

#include "tests/groom/operator_harness.h"

namespace pelage {
namespace {

using CurlTest = OperatorTest;

TEST_F(CurlTest, Bounds) {
  check_bounds(prepared<Curl>({.radius = Field(0.05f), .turns = Field(2.0f), .random = 1, .start = 0.25f}),
               {1, 1, 0});
  check_bounds(prepared<Curl>({.radius = Field(0.2f), .turns = Field(-0.5f), .random = 0, .start = 1}),
               {1, 1, 0});
}

TEST_F(CurlTest, TheCurveWindsAtTheRadius) {
  // 29 points and 3 turns: the spline follows the helix, at the radius asked for and once round per turn.
  const int points = 29;
  const Curl op =
      prepared<Curl>({.radius = Field(0.05f), .turns = Field(3.0f), .random = 1, .start = 0.1f}, points);
  auto batch = straight(0, points);
  op.apply(*batch);
  for (size_t s = 0; s < batch->count; s += 17) {
    const V3f normal = vector_at(batch->rest.normal, s);
    float turned = 0;
    V3f previous(0);
    for (int p = 4; p + 1 < points; ++p) {
      const V3f on_curve =
          (batch->offset(p - 1, s) + batch->offset(p, s) * 4.0f + batch->offset(p + 1, s)) / 6.0f;
      const V3f side = on_curve - normal * normal.dot(on_curve);
      EXPECT_NEAR(side.length(), 0.05f, 1e-4f);
      if (p > 4) turned += std::acos(std::clamp(side.normalized().dot(previous), -1.0f, 1.0f));
      previous = side.normalized();
    }
    EXPECT_NEAR(turned / (2 * std::numbers::pi_v<float>), 3.0f * 23 / 28, 1e-3f);
  }
}

}  // namespace
}  // namespace pelage
