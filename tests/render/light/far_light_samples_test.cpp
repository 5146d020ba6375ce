// SPDX-License-Identifier: Apache-2.0
#include "render/light/far_light_samples.h"

#include <algorithm>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "base/ledger.h"
#include "render/light/environment_light.h"
#include "render/light/sphere_light.h"

namespace pelage {
namespace {

/// A sky that is bright in one corner, and a sphere.
LightSet make_lights(MemoryLedger& ledger) {
  Image image{16, 8, 3, std::vector<float>(16 * 8 * 3)};
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 16; ++x) std::fill_n(image.at(x, y), 3, y == 2 && x > 10 ? 20.0f : 0.1f);
  }
  std::vector<std::unique_ptr<Light>> lights;
  lights.push_back(std::make_unique<EnvironmentLight>("sky",
                                                      std::make_shared<const Texture>(std::move(image)),
                                                      Rgb(1), rotation_xyz({10, 50, 0}), false, ledger));
  lights.push_back(std::make_unique<SphereLight>("sphere", V3f(-1, 2, 0), 0.5f, Rgb(3), false));
  return LightSet(std::move(lights));
}

V2f random_place(uint64_t i) { return {unit_float(hash64(i, 1)), unit_float(hash64(i, 2))}; }

TEST(FarLightSamples, EstimatesWhatTheLightGives) {
  MemoryLedger ledger;
  const LightSet lights = make_lights(ledger);
  // Light that arrives from the upper hemisphere, and from within 60 degrees of an axis; with the mean of
  // all points that a light can give, and with those of four seeds.
  const V3f axis = V3f(0.3f, 0.8f, -0.5f).normalized();
  const auto irradiance = [&](const FarLightSamples& drawn, size_t count) {
    V2f sum(0);
    for (size_t i = 0; i < count; ++i) {
      const auto sample = drawn.sample(0, V3f(0), random_place(i));
      if (!sample) continue;
      EXPECT_FLOAT_EQ(sample->pdf, lights.light(0).pdf(V3f(0), sample->direction));
      const float light = sample->radiance.x / sample->pdf / static_cast<float>(count);
      sum +=
          V2f(std::max(sample->direction.y, 0.0f), sample->direction.dot(axis) > 0.5f ? 1.0f : 0.0f) * light;
    }
    return sum;
  };
  const V2f exact = irradiance(FarLightSamples(lights, 0, false), 200000);
  for (uint64_t seed = 0; seed < 4; ++seed) {
    const V2f drawn = irradiance(FarLightSamples(lights, seed, true), 200000);
    // The noise of 200,000 places, each of one of 128^2 points: below 0.4 %, three deviations.
    EXPECT_NEAR(drawn.x / exact.x, 1, 0.012) << seed;
    EXPECT_NEAR(drawn.y / exact.y, 1, 0.012) << seed;
  }
}

TEST(FarLightSamples, PlacesInTheSameCellGiveTheSamePoint) {
  MemoryLedger ledger;
  const LightSet lights = make_lights(ledger);
  const FarLightSamples drawn(lights, 1, true), other(lights, 2, true);
  constexpr float kCell = 1.0f / FarLightSamples::kSide;
  const auto a = drawn.sample(0, V3f(0), {3.1f * kCell, 7.2f * kCell});
  const auto b = drawn.sample(0, V3f(5), {3.9f * kCell, 7.8f * kCell});
  const auto c = other.sample(0, V3f(0), {3.1f * kCell, 7.2f * kCell});
  ASSERT_TRUE(a && b && c);
  EXPECT_EQ(a->direction, b->direction);
  EXPECT_NE(a->direction, c->direction) << "another seed";
  EXPECT_TRUE(drawn.sample(0, V3f(0), {kBelowOne, kBelowOne}));
}

TEST(FarLightSamples, LightsAtAFiniteDistanceAreSampledAsUsual) {
  MemoryLedger ledger;
  const LightSet lights = make_lights(ledger);
  const FarLightSamples drawn(lights, 1, true);
  for (uint64_t i = 0; i < 100; ++i) {
    const V3f from(unit_float(hash64(i, 3)), 0, 0);
    const auto a = drawn.sample(1, from, random_place(i)), b = lights.light(1).sample(from, random_place(i));
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->direction, b->direction);
    EXPECT_EQ(a->distance, b->distance);
  }
  EXPECT_EQ(FarLightSamples::bytes(lights), size_t{FarLightSamples::kSide} * FarLightSamples::kSide * 32);
}

}  // namespace
}  // namespace pelage
