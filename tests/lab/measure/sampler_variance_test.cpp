// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/sampler_variance.h"

#include <cmath>

#include <gtest/gtest.h>

#include "render/sampling/warp.h"

namespace pelage::sampler_variance_test {
namespace {

constexpr float kDegree = kPi / 180;

TEST(SamplerVariance, OfAnEvenSkyIsThatOfTheDensities) {
  // The integrals of sqrt(1 - u^2)^2 / density, by any width of the shell: exact for the uniform sampler, 32
  // / (3 pi^2) - 1, and by quadrature for the tent. The tolerance is five standard errors of the mean of
  // squares.
  for (const float width : {2.0f, 40.0f}) {
    const TechniqueVariance v = technique_variance({width, 0}, 30 * kDegree, kPi, 1 << 15);
    EXPECT_NEAR(v.shell[0], 0, 1e-5);
    EXPECT_NEAR(v.shell[1], 0.0160, 0.002);
    EXPECT_NEAR(v.shell[2], 32 / (3 * kPi * kPi) - 1, 0.005);
    EXPECT_GT(v.light, 0.1);
  }
  EXPECT_NEAR(technique_variance({90, 0}, 0, kPi, 1 << 15).mean, 1, 0.02);
}

TEST(SamplerVariance, SmallLightsNeedLightSampling) {
  const TechniqueVariance v = technique_variance({40, 0}, 30 * kDegree, kDegree, 1 << 15);
  EXPECT_LT(v.light, 0.01);
  EXPECT_GT(v.shell[0], 100);
  // Both together need twice the rays, but find narrow shells and small lights alike.
  EXPECT_LT(v.both[0], 0.1);
  const TechniqueVariance narrow = technique_variance({2, 0}, 30 * kDegree, 40 * kDegree, 1 << 15);
  EXPECT_LT(narrow.both[0], narrow.light);
}

}  // namespace
}  // namespace pelage::sampler_variance_test
