// SPDX-License-Identifier: Apache-2.0
#include "render/light/plate_light.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "render/light/environment_light.h"

namespace pelage::plate_light_test {

/// Red is the column, green the row.
Image ramp(int width, int height) {
  Image image{width, height, 3, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      image.pixels.insert(image.pixels.end(), {static_cast<float>(x), static_cast<float>(y), 0});
  }
  return image;
}

TEST(PlateLight, ShowsThePictureInScreenSpaceThroughAnyCamera) {
  CameraParams params;
  params.position = Keyed<V3f>({{1.0, V3f(3, 4, 9)}, {2.0, V3f(5, 3, 8)}});
  params.shutter = V2f(0, 0.5f);
  params.shift = V2f(0.2f, -0.1f);
  params.lens = LensParams{2.0f, 1.5f, 7.0f};
  const auto plate = std::make_shared<const Texture>(ramp(64, 32));
  for (const bool parallel : {false, true}) {
    if (parallel) params.projection = CameraProjection::kOrthographic;
    const Camera camera(params, 1, 64, 32);
    const PlateLight light("background", plate, camera, 64);
    for (uint64_t i = 0; i < 100; ++i) {
      const auto random = [&](uint64_t k) { return unit_float(hash64(i, k)); };
      const int x = static_cast<int>(64 * random(0)), y = static_cast<int>(32 * random(1));
      const float time = random(2);
      const CameraRay ray = camera.ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f,
                                       V2f(random(3), random(4)), time);
      const auto hit = light.seen(ray.origin, ray.direction, time);
      EXPECT_EQ(hit->radiance, Rgb(static_cast<float>(x), static_cast<float>(y), 0)) << i;
      EXPECT_TRUE(std::isinf(hit->distance));
    }
    EXPECT_FALSE(light.intersect(V3f(0), V3f(0, 0, 1))) << "it illuminates nothing";
  }
}

TEST(PlateLight, SmallPicturesAreInterpolated) {
  const Camera camera({}, 1, 64, 32);
  const PlateLight light("background", std::make_shared<const Texture>(ramp(4, 2)), camera, 64);
  const CameraRay ray = camera.ray(20, 16, V2f(0.5f), 0);
  const Rgb seen = light.seen(ray.origin, ray.direction, 0)->radiance;
  EXPECT_NEAR(seen.x, 20.0f / 16 - 0.5f, 1e-4f);
  EXPECT_NEAR(seen.y, 0.5f, 1e-4f);
}

TEST(PlateLight, StaysInThePictureWhereFloatsDoNotResolveTheCamera) {
  const Camera camera({}, 1, 64, 32);
  for (const int width : {64, 4}) {
    const PlateLight light("background", std::make_shared<const Texture>(ramp(width, 2)), camera, 64);
    const float nan = std::nanf("");
    EXPECT_EQ(light.seen(V3f(nan), V3f(nan, 0, -1), 0)->radiance, Rgb(0));
  }
}

TEST(EnvironmentLight, TheCameraSeesNoBlocks) {
  MemoryLedger ledger;
  const EnvironmentLight sky("sky", std::make_shared<const Texture>(ramp(8, 4)), Rgb(1), M33f(), true,
                             ledger);
  const auto at = [](float column, float row) {
    const float phi = 2 * 3.14159265f * (column / 8 - 0.5f), polar = 3.14159265f * row / 4;
    return V3f(std::sin(polar) * std::sin(phi), std::cos(polar), -std::sin(polar) * std::cos(phi));
  };
  const auto seen = [&](float column, float row) { return sky.seen(V3f(0), at(column, row), 0)->radiance; };
  EXPECT_NEAR(seen(2.75f, 1.625f).x, 2.25f, 1e-4f);
  EXPECT_NEAR(seen(2.75f, 1.625f).y, 1.125f, 1e-4f);
  EXPECT_NEAR(seen(7.75f, 1.5f).x, 0.75f * 7, 1e-4f) << "the last column is beside the first";
  EXPECT_NEAR(seen(4.5f, 0.2f).y, 0, 1e-4f) << "poles";
  EXPECT_EQ(sky.intersect(V3f(0), at(2.75f, 1.625f))->radiance.x, 2) << "light is as it is sampled";
}

}  // namespace pelage::plate_light_test
