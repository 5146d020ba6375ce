// SPDX-License-Identifier: Apache-2.0
#include "render/sampling/adaptive_rule.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

/// A number from one sample of a pixel, whose mean is 1.
using Sampler = std::function<double(double u)>;

double even(double u) { return 2 * u; }
double exponential(double u) { return -std::log1p(-u); }
/// Rare bright samples on black, as indirect light through fur is.
double spiky(double u) { return u < 0.02 ? 50 : 0; }
/// Rarer ones on grey, as fireflies are.
double fireflies(double u) { return u < 0.001 ? 500.5 : 0.5; }

double random(uint64_t pixel, uint64_t sample) {
  return static_cast<double>(hash64(random_use("adaptive test"), pixel, sample) >> 11) * 0x1p-53;
}

struct Estimate {
  double mean = 0, error = 0;  // over pixels, and its standard error
  double samples = 0;          // of a pixel, on average
};

class Average {
 public:
  void add(double value, double samples) {
    values_.add(value);
    samples_.add(samples);
  }
  Estimate get() const { return {values_.mean, values_.error(), samples_.mean}; }

 private:
  PixelMoments values_, samples_;
};

Estimate by_seed_rule(const Sampler& sampler, uint32_t least, int pixels) {
  Average average;
  for (int p = 0; p < pixels; ++p) {
    PixelMoments m;
    do {
      for (int i = 0; i < 16; ++i) m.add(sampler(random(p, m.count)));
    } while (m.count < least || (!looks_converged(m, 0.05) && m.count < 8192));
    average.add(m.mean, m.count);
  }
  return average.get();
}

/// `own_pilot`: a pixel's count comes from its own pilot in place of its neighbours'.
Estimate by_two_stages(const Sampler& sampler, const AdaptiveParams& params, int frames,
                       bool own_pilot = false) {
  constexpr int kWidth = 24, kHeight = 17;
  constexpr uint32_t kMost = 2048;
  Average average;
  for (int frame = 0; frame < frames; ++frame) {
    const auto pilot_samples = static_cast<uint32_t>(params.pilot);
    std::vector<PixelMoments> pixels(size_t{kWidth} * kHeight);
    Pilot pilot{kWidth, kHeight, pilot_samples, {}};
    const auto number = [&](size_t p) { return frame * pixels.size() + p; };
    for (size_t p = 0; p < pixels.size(); ++p) {
      while (pixels[p].count < pilot_samples) pixels[p].add(sampler(random(number(p), pixels[p].count)));
      pilot.pixels.push_back(
          {static_cast<float>(pixels[p].mean), static_cast<float>(pixels[p].variance()), true});
    }
    const std::vector<float> counts = two_stage_counts(pilot, params, kMost);
    for (size_t p = 0; p < pixels.size(); ++p) {
      double count = counts[p];
      if (own_pilot) {
        const double root = kConfidence / (params.noise * pixels[p].mean);
        count = pixels[p].mean > 0 ? pixels[p].variance() * root * root : kMost;
      }
      count = std::clamp(std::ceil(count), static_cast<double>(pilot_samples), static_cast<double>(kMost));
      while (pixels[p].count < count) pixels[p].add(sampler(random(number(p), pixels[p].count)));
      average.add(pixels[p].mean, pixels[p].count);
    }
  }
  return average.get();
}

TEST(AdaptiveSeedRule, IsBiasedAsPredicted) {
  // What the design note found for a tolerance of 0.05, batches of 16 and at most 8192 samples.
  EXPECT_NEAR(by_seed_rule(even, 0, 2000).mean, 1, 2e-3);
  EXPECT_NEAR(by_seed_rule(exponential, 0, 2000).mean, 1, 2e-3);
  const Estimate spikes = by_seed_rule(spiky, 0, 4000);
  EXPECT_NEAR(spikes.mean, 0.270, 4 * spikes.error);
  EXPECT_NEAR(by_seed_rule(fireflies, 0, 20000).mean, 0.509, 0.004);
  EXPECT_NEAR(by_seed_rule(fireflies, 128, 6000).mean, 1 - 0.43, 0.02)
      << "a larger first batch does not help";
}

TEST(AdaptiveTwoStage, IsUnbiasedWhereTheSeedRuleIsNot) {
  for (NoiseGoal goal : {NoiseGoal::kFrame, NoiseGoal::kPixel}) {
    AdaptiveParams params;
    params.goal = goal;
    params.noise = 0.2f;
    for (const Sampler& sampler : {Sampler(even), Sampler(exponential), Sampler(spiky), Sampler(fireflies)}) {
      const Estimate e = by_two_stages(sampler, params, 40);
      EXPECT_NEAR(e.mean, 1, 4 * e.error);
      EXPECT_LT(e.error, 0.03);
      EXPECT_GE(e.samples, params.pilot);
    }
  }
}

/// The test above would see it if counts depended on the pixel's own pilot.
TEST(AdaptiveTwoStage, CountsFromThePixelsOwnPilotWouldBeBiased) {
  AdaptiveParams params;
  params.noise = 0.2f;
  const Estimate e = by_two_stages(fireflies, params, 40, true);
  EXPECT_LT(e.mean, 1 - 10 * e.error);
}

/// A frame whose left half is grey without noise, and whose right half is noisy.
Pilot half_noisy(int width, int height) {
  Pilot pilot{width, height, 16, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      pilot.pixels.push_back(x < width / 2 ? PilotPixel{0.5f, 0, false} : PilotPixel{1, 1, true});
  }
  return pilot;
}

TEST(AdaptiveTwoStage, WhereNothingVariesThePilotIsEnough) {
  const Pilot pilot = half_noisy(32, 16);
  const std::vector<float> counts = two_stage_counts(pilot, {}, 100000);
  const double needed = std::pow(kConfidence / 0.05, 2) / 1.01;  // darkest pixels count as 0.1 bright
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) {
      const float count = counts[static_cast<size_t>(32 * y + x)];
      if (x < 14) {
        EXPECT_EQ(count, 0) << x;
      } else if (x < 18) {
        EXPECT_GT(count, 0) << x;
      } else {
        EXPECT_NEAR(count, needed, 0.1 * needed) << x;
      }
    }
  }
}

TEST(AdaptiveTwoStage, TheOneColorNeverSeesItself) {
  const Pilot pilot = half_noisy(32, 16);
  Pilot changed = pilot;
  for (int y = 0; y < 16; ++y) {
    for (int x = y % 2; x < 32; x += 2) changed.pixels[static_cast<size_t>(32 * y + x)] = {3, 17, true};
  }
  const std::vector<float> before = two_stage_counts(pilot, {}, 4096),
                           after = two_stage_counts(changed, {}, 4096);
  for (int y = 0; y < 16; ++y) {
    for (int x = y % 2; x < 32; x += 2) {
      const auto i = static_cast<size_t>(32 * y + x);
      EXPECT_EQ(before[i], after[i]);
      EXPECT_NE(before[i ^ 1], after[i ^ 1]);
    }
  }
}

/// The mean of variance / count over the frame is what was asked for, and counts in proportion to the
/// variance would have to be more in all.
TEST(AdaptiveTwoStage, TheFrameKeepsItsBudgetByTheFewestSamples) {
  Pilot pilot{64, 64, 16, {}};
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const float sd = x < 32 ? 0.5f : 3.0f;
      pilot.pixels.push_back({1, sd * sd, true});
    }
  }
  AdaptiveParams params;
  const std::vector<float> counts = two_stage_counts(pilot, params, 1 << 20);
  double noise = 0, samples = 0;
  for (size_t i = 0; i < counts.size(); ++i) {
    noise += pilot.pixels[i].variance / 1.01 / counts[i];
    samples += counts[i];
  }
  EXPECT_NEAR(kConfidence * std::sqrt(noise / 4096), params.noise, 0.02 * params.noise);
  const double by_variance = std::pow(kConfidence / params.noise, 2) * (0.25 + 9) / 2 / 1.01;
  const double by_root = by_variance * (0.5 + 3) * (0.5 + 3) / 4 / ((0.25 + 9) / 2);
  EXPECT_NEAR(samples / 4096, by_root, 0.05 * by_root);
}

TEST(AdaptiveTwoStage, WhatThePilotCannotKnowGetsPlenty) {
  Pilot one{1, 1, 16, {{1, 1, true}}};
  EXPECT_EQ(two_stage_counts(one, {}, 500), std::vector<float>{500});
  Pilot black{8, 8, 16, std::vector<PilotPixel>(64, PilotPixel{0, 0, true})};
  for (float count : two_stage_counts(black, {}, 500)) EXPECT_EQ(count, 500);
  // A black patch in a noisy frame gets what pixels get on average.
  Pilot patch{32, 32, 16, std::vector<PilotPixel>(1024, PilotPixel{1, 1, true})};
  for (int y = 8; y < 24; ++y) {
    for (int x = 8; x < 24; ++x) patch.pixels[static_cast<size_t>(32 * y + x)] = {0, 0, true};
  }
  const std::vector<float> counts = two_stage_counts(patch, {}, 100000);
  EXPECT_NEAR(counts[16 * 32 + 16], counts[0], 0.2 * counts[0]);
}

TEST(FrameNoise, IsThatOfThePixelsThatVary) {
  std::vector<PixelMoments> pixels(10);
  EXPECT_EQ(frame_noise(pixels), 0);
  for (size_t i = 5; i < 10; ++i) {
    for (int s = 0; s < 100; ++s) pixels[i].add(s % 2 ? 1.5 : 0.5);
  }
  EXPECT_NEAR(frame_noise(pixels), 1.96 * 0.05 / std::sqrt(1.01), 1e-3);
}

}  // namespace
}  // namespace pelage
