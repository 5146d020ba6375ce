// SPDX-License-Identifier: Apache-2.0
#include "render/gather/light_sharing.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "render/sampling/pixel_moments.h"
#include "render/sampling/systematic_choice.h"

namespace pelage::light_sharing_test {
namespace {

/// Points with unoccluded light from two light points of each of two lights, some of which reach them.
struct Points {
  static constexpr uint32_t kCount = 600, kGatherPoints = 40, kZones = 3, kLights = 2, kLightPoints = 2;
  static constexpr size_t kNumbers = 3 * kLobeGroups * kLights;  // of a gather point

  static uint32_t gather_point(uint32_t point) {
    return static_cast<uint32_t>(hash64(point, 1) % kGatherPoints);
  }
  static uint32_t zone(uint32_t gather_point) { return gather_point % kZones; }
  /// Light from a light point by lobe group, in many colours.
  static std::array<Rgb, kLobeGroups> part(uint32_t point, uint32_t light, uint32_t from) {
    std::array<Rgb, kLobeGroups> lobes;
    for (uint32_t g = 0; g < kLobeGroups; ++g) {
      for (int c = 0; c < 3; ++c)
        lobes[g][c] = 0.02f + unit_float(hash64(point, light, from, g, static_cast<uint32_t>(c)));
    }
    return lobes;
  }
  static float luminance_of(const std::array<Rgb, kLobeGroups>& lobes) {
    float sum = 0;
    for (const Rgb& lobe : lobes) sum += luminance(lobe);
    return sum;
  }
  /// In zone 0 little arrives, in zone 2 almost all. Red light is blocked more often.
  static float through(uint32_t point, uint32_t light, uint32_t from) {
    const auto lobes = part(point, light, from);
    const float red = lobes[0].x / (lobes[0].x + lobes[0].y + lobes[0].z);
    const float chance = 0.3f + 0.4f * static_cast<float>(zone(gather_point(point))) - 0.5f * red;
    return unit_float(hash64(point, light, from, 99)) < chance ? 1.0f : 0.0f;
  }
  /// Index in the vectors below.
  static size_t index(uint32_t gather_point, uint32_t light, uint32_t group, uint32_t c) {
    return gather_point * kNumbers + (light * kLobeGroups + group) * 3 + c;
  }
  /// Sums over the points of each gather point, by light, lobe group and colour: of what arrives, or of
  /// everything.
  static std::vector<double> sums(bool arriving) {
    std::vector<double> result(kGatherPoints * kNumbers);
    for (uint32_t p = 0; p < kCount; ++p) {
      for (uint32_t l = 0; l < kLights; ++l) {
        for (uint32_t from = 0; from < kLightPoints; ++from) {
          const auto lobes = part(p, l, from);
          const float share = arriving ? through(p, l, from) : 1.0f;
          for (uint32_t g = 0; g < kLobeGroups; ++g) {
            for (uint32_t c = 0; c < 3; ++c)
              result[index(gather_point(p), l, g, c)] += share * lobes[g][static_cast<int>(c)];
          }
        }
      }
    }
    return result;
  }
  /// The light that `sharing` computes for each gather point.
  static std::vector<double> sums(const LightSharing& sharing) {
    std::vector<double> result = sums(false);
    for (uint32_t k = 0; k < kGatherPoints; ++k) {
      for (uint32_t l = 0; l < kLights; ++l) {
        for (uint32_t g = 0; g < kLobeGroups; ++g) {
          for (uint32_t c = 0; c < 3; ++c)
            result[index(k, l, g, c)] *= sharing.fraction(k, l, static_cast<int>(g))[static_cast<int>(c)];
        }
      }
    }
    return result;
  }
};

/// Guess of the fraction that arrives in a zone: 0, or about the mean fraction.
float guess_in(uint32_t zone, bool guess) { return guess ? 0.15f + 0.4f * static_cast<float>(zone) : 0.0f; }

/// Adds every point, and rays of about the given part of them, chosen for each gather point independently. A
/// ray goes to one of the light points, chosen in proportion to its luminance.
void add(LightSharing& sharing, bool guess, double part, uint64_t trial) {
  sharing.begin(Points::kLights, Points::kLights);
  std::vector<SystematicChoice> choices;
  for (uint64_t k = 0; k < Points::kGatherPoints; ++k) {
    choices.emplace_back(1 / part, unit_float(hash64(trial, k, random_use("choice"))));
  }
  for (uint32_t p = 0; p < Points::kCount; ++p) {
    const uint32_t gather_point = Points::gather_point(p);
    const float expected = guess_in(Points::zone(gather_point), guess);
    for (uint32_t light = 0; light < Points::kLights; ++light) {
      float masses[Points::kLightPoints] = {}, sum = 0;
      for (uint32_t from = 0; from < Points::kLightPoints; ++from) {
        const auto lobes = Points::part(p, light, from);
        sharing.add_unoccluded(gather_point, light, lobes.data());
        sharing.add_arriving(gather_point, light, lobes.data(), expected);
        masses[from] = Points::luminance_of(lobes);
        sum += masses[from];
      }
      SystematicChoice target(sum, unit_float(hash64(trial, p, light)));
      uint32_t to = 0;
      while (to + 1 < Points::kLightPoints && target.times(masses[to]) == 0) ++to;
      const uint32_t times = choices[gather_point].times(sum);
      if (times == 0) continue;
      const auto lobes = Points::part(p, light, to);
      const double factor = times * choices[gather_point].step() / masses[to];
      sharing.add_arriving(gather_point, light, lobes.data(),
                           static_cast<float>(factor) * (Points::through(p, light, to) - expected));
    }
  }
  sharing.finish(Points::kGatherPoints);
}

/// As with DepthProfile: unoccluded light is multiplied by a factor of its point, and so is the fraction.
TEST(LightSharing, FactorsOfPointsKeepTheLightOfAGatherPoint) {
  constexpr uint32_t kPoints = 50;
  LightSharing sharing;
  sharing.begin(1, 1);
  const auto factor = [](uint32_t point) { return std::exp2(20 * unit_float(hash64(point, 5)) - 10); };
  Rgb arriving(0);
  for (uint32_t p = 0; p < kPoints; ++p) {
    auto lobes = Points::part(p, 0, 0);
    const float through = unit_float(hash64(p, 6));
    sharing.add_arriving(0, 0, lobes.data(), through);
    arriving += through * lobes[1];
    for (Rgb& lobe : lobes) lobe *= factor(p);
    sharing.add_unoccluded(0, 0, lobes.data());
  }
  sharing.finish(1);
  Rgb shared(0);
  for (uint32_t p = 0; p < kPoints; ++p)
    shared += Points::part(p, 0, 0)[1] * factor(p) * sharing.fraction(0, 0, 1);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(shared[c], arriving[c], 1e-4f * arriving[c]);
}

TEST(LightSharing, IsExactWhenEveryLightPointHasItsRay) {
  LightSharing sharing;
  sharing.begin(Points::kLights, Points::kLights);
  for (uint32_t p = 0; p < Points::kCount; ++p) {
    const uint32_t gather_point = Points::gather_point(p);
    for (uint32_t light = 0; light < Points::kLights; ++light) {
      for (uint32_t from = 0; from < Points::kLightPoints; ++from) {
        const auto lobes = Points::part(p, light, from);
        sharing.add_unoccluded(gather_point, light, lobes.data());
        sharing.add_arriving(gather_point, light, lobes.data(), Points::through(p, light, from));
      }
    }
  }
  sharing.finish(Points::kGatherPoints);
  const std::vector<double> truth = Points::sums(true), sums = Points::sums(sharing);
  for (size_t i = 0; i < truth.size(); ++i) EXPECT_NEAR(sums[i], truth[i], 1e-4 * (1 + truth[i])) << i;
}

/// Mean and variance, over many choices of rays, of the light of each gather point.
std::vector<PixelMoments> moments(bool guess) {
  std::vector<PixelMoments> result(Points::kGatherPoints * Points::kNumbers);
  LightSharing sharing;
  for (uint64_t trial = 0; trial < 2000; ++trial) {
    add(sharing, guess, 0.4, trial);
    const std::vector<double> sums = Points::sums(sharing);
    for (size_t i = 0; i < sums.size(); ++i) result[i].add(sums[i]);
  }
  return result;
}

TEST(LightSharing, IsRightOnAverageAndAGuessMakesItLessNoisy) {
  const std::vector<double> truth = Points::sums(true);
  const std::vector<PixelMoments> guessed = moments(true), alone = moments(false);
  double guessed_variance = 0, alone_variance = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(guessed[i].mean, truth[i], 4.5 * guessed[i].error() + 1e-4) << i;
    EXPECT_NEAR(alone[i].mean, truth[i], 4.5 * alone[i].error() + 1e-4) << i;
    guessed_variance += guessed[i].variance();
    alone_variance += alone[i].variance();
  }
  EXPECT_LT(guessed_variance, 0.9 * alone_variance);
}

}  // namespace
}  // namespace pelage::light_sharing_test
