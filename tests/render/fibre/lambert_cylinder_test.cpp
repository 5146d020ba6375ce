// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/lambert_cylinder.h"

#include <gtest/gtest.h>

#include "tests/render/fibre/fibre_models.h"

namespace pelage {
namespace {

/// Average over h of rho / cos(theta_i).
double far_f(float theta_o, float theta_i, float phi) {
  const FibrePoint point = fibre_point_at(theta_o, 0);
  const FibreFrame frame(point.tangents[0], point.wo);
  const V3f wi = fibre_direction(point, theta_i, phi);
  constexpr int kOffsets = 20000;
  double sum = 0;
  for (int i = 0; i < kOffsets; ++i) {
    const float h = 2 * (static_cast<float>(i) + 0.5f) / kOffsets - 1;
    sum += LambertCylinderBsdf(Rgb(1), frame, h).eval(wi).total().x;
  }
  return sum / kOffsets / std::cos(theta_i);
}

TEST(LambertCylinder, AverageOverTheFibreIsTheFarField) {
  EXPECT_NEAR(far_f(0.2f, -0.3f, 0), 0.25, 1e-4);
  EXPECT_NEAR(far_f(0.2f, -0.3f, kPi / 2), 0.079577, 1e-4);
  EXPECT_NEAR(far_f(0.2f, -0.3f, kPi), 0, 1e-4);
  for (float phi : {0.4f, -1.3f, 2.5f}) {
    const double x = std::abs(phi);
    EXPECT_NEAR(far_f(0.5f, 0.7f, phi), ((kPi - x) * std::cos(x) + std::sin(x)) / (4 * kPi), 1e-4);
    EXPECT_NEAR(far_f(0.7f, 0.5f, phi), far_f(0.5f, 0.7f, phi), 1e-4);
  }
}

TEST(LambertCylinder, NothingComesThrough) {
  const FibrePoint point = fibre_point_at(0, 0);
  const FibreFrame frame(point.tangents[0], point.wo);
  const LambertCylinderBsdf bsdf(Rgb(1), frame, 0);
  EXPECT_EQ(bsdf.eval(-point.wo).total(), Rgb(0));
  TestRandom random(2);
  for (int i = 0; i < 1000; ++i) {
    const auto s = bsdf.sample(random.unit3());
    if (!s) continue;
    EXPECT_GE(s->wi.dot(point.wo), 0);
    EXPECT_NEAR(s->value.total().x / s->value.pdf, 1, 1e-5);
  }
}

}  // namespace
}  // namespace pelage
