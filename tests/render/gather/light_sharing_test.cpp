// SPDX-License-Identifier: Apache-2.0
#include "render/gather/light_sharing.h"

#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "render/sampling/pixel_moments.h"
#include "render/sampling/systematic_choice.h"

namespace pelage {
namespace {

/// Points with unoccluded light from two lights, which some of them receive.
struct Points {
  static constexpr uint32_t kCount = 600, kKnots = 40, kZones = 3, kLights = 2;

  static uint32_t knot(uint32_t point) { return static_cast<uint32_t>(hash64(point, 1) % kKnots); }
  static uint32_t zone(uint32_t knot) { return knot % kZones; }
  static float unoccluded(uint32_t point, uint32_t light) {
    return 0.1f + unit_float(hash64(point, light, 2));
  }
  /// In zone 0 little arrives, in zone 2 almost all.
  static float through(uint32_t point, uint32_t light) {
    const float chance = 0.1f + 0.4f * static_cast<float>(zone(knot(point)));
    return unit_float(hash64(point, light, 3)) < chance ? 1.0f : 0.0f;
  }
  static std::vector<uint32_t> zones() {
    std::vector<uint32_t> result(kKnots);
    for (uint32_t k = 0; k < kKnots; ++k) result[k] = zone(k);
    return result;
  }
  /// The light that reaches the points of each knot.
  static std::vector<double> truth() {
    std::vector<double> result(kKnots * kLights);
    for (uint32_t p = 0; p < kCount; ++p) {
      for (uint32_t l = 0; l < kLights; ++l)
        result[knot(p) * kLights + l] += unoccluded(p, l) * through(p, l);
    }
    return result;
  }
};

/// Adds every point, and rays of about the given part of them, chosen for each knot independently.
void add(LightSharing& sharing, bool guess, double part, uint64_t trial) {
  sharing.begin(Points::kLights, guess);
  std::vector<SystematicChoice> choices;
  for (uint64_t k = 0; k < Points::kKnots; ++k) {
    choices.emplace_back(1 / part, unit_float(hash64(trial, k, random_use("choice"))));
  }
  for (uint32_t p = 0; p < Points::kCount; ++p) {
    const uint32_t knot = Points::knot(p);
    for (uint32_t light = 0; light < Points::kLights; ++light) {
      const float u = Points::unoccluded(p, light);
      sharing.add_unoccluded(knot, light, u);
      const uint32_t times = choices[knot].times(u);
      if (times == 0) continue;
      const auto stands_for = static_cast<float>(times * choices[knot].step());
      sharing.add_ray(knot, Points::zone(knot), light, stands_for, Points::through(p, light));
    }
  }
  sharing.finish(Points::zones());
}

std::vector<double> unoccluded_of_knots() {
  std::vector<double> result(Points::kKnots * Points::kLights);
  for (uint32_t p = 0; p < Points::kCount; ++p) {
    for (uint32_t l = 0; l < Points::kLights; ++l) {
      result[Points::knot(p) * Points::kLights + l] += Points::unoccluded(p, l);
    }
  }
  return result;
}

TEST(LightSharing, IsExactWhenEveryPointHasItsRays) {
  LightSharing sharing;
  sharing.begin(Points::kLights, true);
  for (uint32_t p = 0; p < Points::kCount; ++p) {
    const uint32_t knot = Points::knot(p);
    for (uint32_t light = 0; light < Points::kLights; ++light) {
      const float u = Points::unoccluded(p, light);
      sharing.add_unoccluded(knot, light, u);
      sharing.add_ray(knot, Points::zone(knot), light, u, Points::through(p, light));
    }
  }
  sharing.finish(Points::zones());
  const std::vector<double> truth = Points::truth(), all = unoccluded_of_knots();
  for (uint32_t k = 0; k < Points::kKnots; ++k) {
    for (uint32_t l = 0; l < Points::kLights; ++l) {
      const size_t i = k * Points::kLights + l;
      EXPECT_NEAR(sharing.fraction(k, l) * all[i], truth[i], 1e-4 * (1 + truth[i])) << k;
    }
  }
}

/// Mean and variance, over many choices of rays, of the light of each knot.
std::vector<PixelMoments> moments(bool guess) {
  const std::vector<double> all = unoccluded_of_knots();
  std::vector<PixelMoments> result(all.size());
  LightSharing sharing;
  for (uint64_t trial = 0; trial < 4000; ++trial) {
    add(sharing, guess, 0.4, trial);
    for (uint32_t k = 0; k < Points::kKnots; ++k) {
      for (uint32_t l = 0; l < Points::kLights; ++l) {
        result[k * Points::kLights + l].add(sharing.fraction(k, l) * all[k * Points::kLights + l]);
      }
    }
  }
  return result;
}

TEST(LightSharing, IsRightOnAverageAndTheOtherKnotsOfItsZoneMakeItLessNoisy) {
  const std::vector<double> truth = Points::truth();
  const std::vector<PixelMoments> guessed = moments(true), alone = moments(false);
  double guessed_variance = 0, alone_variance = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(guessed[i].mean, truth[i], 4.5 * guessed[i].error() + 1e-4) << i;
    EXPECT_NEAR(alone[i].mean, truth[i], 4.5 * alone[i].error() + 1e-4) << i;
    guessed_variance += guessed[i].variance();
    alone_variance += alone[i].variance();
  }
  EXPECT_LT(guessed_variance, 0.8 * alone_variance);
}

TEST(LightSharing, LearnsTheChanceOfEachLightByZone) {
  LightSharing sharing;
  sharing.begin(2, true);
  EXPECT_EQ(sharing.chance(0, 0), 1.0f) << "nothing is known";
  for (int i = 0; i < 100; ++i) {
    sharing.add_ray(5, 0, 0, 2.0f, i % 4 == 0 ? 1.0f : 0.0f);
    sharing.add_ray(6, 1, 1, 1.0f, 0.0f);
  }
  EXPECT_NEAR(sharing.chance(0, 0), 0.25f, 0.01f);
  EXPECT_GT(sharing.chance(1, 1), 0) << "no light is given up";
  EXPECT_LT(sharing.chance(1, 1), 0.05f);
  EXPECT_EQ(sharing.chance(1, 0), 1.0f);
}

}  // namespace
}  // namespace pelage
