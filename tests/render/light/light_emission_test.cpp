// SPDX-License-Identifier: Apache-2.0
#include "render/light/light_emission.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace pelage {
namespace {

/// CIE xy of a linear Rec. 709 colour.
V2f chromaticity(const Rgb& c) {
  const float x = 0.4124564f * c.x + 0.3575761f * c.y + 0.1804375f * c.z;
  const float y = 0.2126729f * c.x + 0.7151522f * c.y + 0.0721750f * c.z;
  const float z = 0.0193339f * c.x + 0.1191920f * c.y + 0.9503041f * c.z;
  return {x / (x + y + z), y / (x + y + z)};
}

TEST(BlackBody, HasKnownChromaticities) {
  // Illuminant A of the CIE is a black body of 2856 K; the others are points of the Planckian locus. The fit
  // is good to 1e-3.
  const std::pair<float, V2f> points[] = {{2856.0f, {0.4476f, 0.4074f}},
                                          {4000.0f, {0.3805f, 0.3768f}},
                                          {6500.0f, {0.3135f, 0.3237f}},
                                          {10000.0f, {0.2807f, 0.2884f}}};
  for (const auto& [kelvin, expected] : points) {
    const V2f found = chromaticity(black_body_color(kelvin));
    EXPECT_NEAR(found.x, expected.x, 1e-3) << kelvin;
    EXPECT_NEAR(found.y, expected.y, 1e-3) << kelvin;
  }
}

TEST(BlackBody, IsNeverNegativeAndKeepsTheLuminance) {
  for (float kelvin = 1000; kelvin < 40000; kelvin *= 1.1f) {
    const Rgb color = black_body_color(kelvin);
    EXPECT_NEAR(luminance(color), 1, 1e-5f) << kelvin;
    EXPECT_GE(std::min({color.x, color.y, color.z}), 0) << kelvin;
    if (kelvin > 2000 && kelvin < 24000) {
      EXPECT_GT(color.x / color.z, black_body_color(1.05f * kelvin).x / black_body_color(1.05f * kelvin).z);
    }
  }
}

}  // namespace
}  // namespace pelage
