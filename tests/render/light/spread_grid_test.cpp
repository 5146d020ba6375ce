// SPDX-License-Identifier: Apache-2.0
#include "render/light/spread_grid.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "image/texture_library.h"
#include "render/light/disk_light.h"
#include "render/light/light_params.h"
#include "tests/render/light/light_checks.h"

namespace pelage::spread_grid_test {
namespace {

constexpr double kPiD = std::numbers::pi;

TEST(SpreadGrid, LetsTheFractionPassThatItStates) {
  for (const float degrees : {1.0f, 30.0f, 90.0f, 150.0f, 180.0f}) {
    const SpreadGrid grid(degrees);
    double sum = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      const double angle = (i + 0.5) / kSteps * kPiD / 2;
      sum += 2 * std::sin(angle) * std::cos(angle) * grid.factor(static_cast<float>(std::cos(angle))) * kPiD /
             2 / kSteps;
    }
    // A float cosine resolves a half angle of 0.5 degrees to 1e-3.
    EXPECT_NEAR(grid.passed_fraction() / sum, 1, degrees < 2 ? 2e-2 : 1e-3) << degrees;
    EXPECT_EQ(grid.factor(1), 1);
    EXPECT_EQ(grid.factor(static_cast<float>(std::cos(degrees * 0.51 * kPiD / 180))), degrees < 180 ? 0 : 1);
  }
}

TEST(SpreadGrid, PanelsKeepTheirPower) {
  // Far away, the intensity of a panel is radiance * area * cosine; its integral is the power.
  MemoryLedger ledger;
  TextureLibrary textures(ledger);
  for (const float spread : {40.0f, 120.0f, 180.0f}) {
    RectangleLightParams rectangle;
    rectangle.size = V2f(0.5f, 2);
    DiskLightParams disk;
    rectangle.spread = disk.spread = spread;
    rectangle.power = disk.power = 60.0f;
    const auto power = [&](const LightParams& params, double area) {
      const auto light = make_light("l", params, 1, textures, ledger);
      double sum = 0;
      constexpr int kSteps = 2000;
      for (int i = 0; i < kSteps; ++i) {
        const double angle = (i + 0.5) / kSteps * kPiD / 2;
        const V3f away(static_cast<float>(std::sin(angle)), 0, static_cast<float>(-std::cos(angle)));
        const auto hit = light->intersect(100.0f * away, -away);
        if (hit)
          sum += hit->radiance.x * area * std::cos(angle) * 2 * kPiD * std::sin(angle) * kPiD / 2 / kSteps;
      }
      return sum;
    };
    EXPECT_NEAR(power(rectangle, 1), 60, 0.1) << spread;
    EXPECT_NEAR(power(disk, kPiD / 4), 60, 0.1) << spread;
  }
}

TEST(SpreadGrid, SamplesAndRaysOfADiskAgree) {
  const DiskLight disk("d", V3f(0), V3f(0, 0, 1), 0.5f, Rgb(1), true, SpreadGrid(60));
  for (const V3f& from : {V3f(0, 0, 2), V3f(1.2f, 0.1f, 2), V3f(0.2f, 0, 0.3f), V3f(3, 1, 20)})
    expect_agreement(disk, from);
}

}  // namespace
}  // namespace pelage::spread_grid_test
