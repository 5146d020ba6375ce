// SPDX-License-Identifier: Apache-2.0
#include "render/surface/glossy.h"

#include <gtest/gtest.h>

#include "tests/render/random.h"
#include "tests/support/chi_square.h"

namespace pelage {
namespace {

const V3f kNormal = V3f(0.3f, -0.5f, 0.8f).normalized();

// Viewing direction at an angle from the normal.
V3f viewer(float angle) {
  V3f x, y;
  complete_frame(kNormal, x, y);
  return std::cos(angle) * kNormal + std::sin(angle) * (0.6f * x + 0.8f * y);
}

TEST(Glossy, SamplesCarryTheValueOfTheirDirection) {
  const GlossyBsdf bsdf(Rgb(0.4f), 0.3f, 1.5f, kNormal, viewer(0.8f));
  TestRandom random(3);
  for (int i = 0; i < 200; ++i) {
    const auto drawn = bsdf.sample(random.unit3());
    if (!drawn) continue;
    const GlossyValue value = bsdf.eval(drawn->wi);
    EXPECT_NEAR(drawn->value.pdf, value.pdf, 2e-3f * value.pdf);
    EXPECT_NEAR(drawn->value.specular, value.specular, 2e-3f * value.specular + 1e-6f);
  }
}

// A black base leaves the coat alone, which at normal incidence reflects ((ior - 1) / (ior + 1))^2.
TEST(Glossy, CoatReflectsWhatFresnelSays) {
  const GlossyBsdf bsdf(Rgb(0), 0.2f, 1.5f, kNormal, kNormal);
  TestRandom random(11);
  RunningMean mean;
  for (int i = 0; i < 20000; ++i) {
    const auto drawn = bsdf.sample(random.unit3());
    mean.add(drawn ? drawn->value.specular / drawn->value.pdf : 0);
  }
  EXPECT_NEAR(mean.mean(), 0.04, 0.0005);
}

}  // namespace
}  // namespace pelage
