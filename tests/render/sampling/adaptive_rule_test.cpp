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

/// A thing so thin that most probes of a pixel, and many of its whole neighbourhood, miss it.
double whisker(double u) { return u < 0.01 ? 100 : 0; }

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

/// What a pixel decides by that should be decided by others.
enum class Peek { kNone, kOwnProbe, kOwnPilot };

/// What is not 0 counts as met.
Estimate by_two_stages(const Sampler& sampler, const AdaptiveParams& params, int frames,
                       Peek peek = Peek::kNone) {
  constexpr int kWidth = 24, kHeight = 17;
  constexpr double kMax = 2048;
  Average average;
  for (int frame = 0; frame < frames; ++frame) {
    std::vector<PixelMoments> pixels(size_t{kWidth} * kHeight);
    const auto bring_to = [&](size_t p, double count) {
      while (pixels[p].count < count)
        pixels[p].add(sampler(random(frame * pixels.size() + p, pixels[p].count)));
    };
    const auto pilot = [&] {
      Pilot result{kWidth, kHeight, {}};
      for (const PixelMoments& m : pixels) {
        result.pixels.push_back(
            {static_cast<float>(m.mean), static_cast<float>(m.variance()), m.mean > 0, m.count});
      }
      return result;
    };
    for (size_t p = 0; p < pixels.size(); ++p) bring_to(p, params.pilot / 4);
    std::vector<uint8_t> worth = needs_full_pilot(pilot());
    for (size_t p = 0; p < pixels.size(); ++p) {
      if (peek == Peek::kOwnProbe) worth[p] = pixels[p].mean > 0;
      if (worth[p]) bring_to(p, params.pilot);
    }
    const std::vector<float> counts = two_stage_counts(pilot(), params, static_cast<uint32_t>(kMax));
    for (size_t p = 0; p < pixels.size(); ++p) {
      double count = counts[p];
      if (peek == Peek::kOwnProbe) count = 0;
      if (peek == Peek::kOwnPilot) {
        const double root = kConfidence / (params.noise * pixels[p].mean);
        count = pixels[p].mean > 0 ? pixels[p].variance() * root * root : kMax;
      }
      bring_to(p, whole_blocks(std::min(count, kMax)));
      average.add(pixels[p].mean, pixels[p].count);
    }
  }
  return average.get();
}

TEST(AdaptiveTwoStage, IsUnbiased) {
  for (NoiseGoal goal : {NoiseGoal::kFrame, NoiseGoal::kPixel}) {
    AdaptiveParams params;
    params.goal = goal;
    params.noise = 0.2f;
    for (const Sampler& sampler :
         {Sampler(even), Sampler(exponential), Sampler(spiky), Sampler(fireflies), Sampler(whisker)}) {
      const Estimate e = by_two_stages(sampler, params, 40);
      EXPECT_NEAR(e.mean, 1, 4 * e.error);
      EXPECT_LT(e.error, 0.03);
      EXPECT_GE(e.samples, params.pilot / 4);
    }
  }
}

/// The test above would see it if counts depended on the pixel's own samples.
TEST(AdaptiveTwoStage, CountsFromThePixelsOwnSamplesWouldBeBiased) {
  AdaptiveParams params;
  params.noise = 0.2f;
  const Estimate by_pilot = by_two_stages(fireflies, params, 40, Peek::kOwnPilot);
  EXPECT_LT(by_pilot.mean, 1 - 10 * by_pilot.error);
  const Estimate by_probe = by_two_stages(whisker, params, 40, Peek::kOwnProbe);
  EXPECT_LT(by_probe.mean, 1 - 10 * by_probe.error);
}

TEST(AdaptiveTwoStage, ThePilotGoesWhereOthersOfTheColorMetSomethingOrDiffer) {
  const PilotPixel sky{0.5f, 0, false, 4};
  const Pilot empty{16, 16, std::vector<PilotPixel>(256, sky)};
  const std::vector<uint8_t> none = needs_full_pilot(empty);
  EXPECT_EQ(std::count(none.begin(), none.end(), 0), 256);
  for (const PilotPixel& odd :
       {PilotPixel{0.5f, 0, true, 4}, PilotPixel{0.5f, 0.1f, false, 4}, PilotPixel{0.6f, 0, false, 4}}) {
    Pilot probe = empty;
    probe.pixels[16 * 8 + 8] = odd;
    const std::vector<uint8_t> worth = needs_full_pilot(probe);
    EXPECT_EQ(worth[16 * 8 + 8], 0) << "never by itself";
    EXPECT_EQ(worth[16 * 8 + 9], 0) << "the other colour";
    EXPECT_EQ(std::count(worth.begin(), worth.end(), 1), 12);
    EXPECT_EQ(worth[16 * 10 + 8] + worth[16 * 7 + 7] + worth[16 * 6 + 10], 3);
  }
  EXPECT_EQ(needs_full_pilot({1, 1, {sky}}), std::vector<uint8_t>{1}) << "no neighbours";
}

TEST(AdaptiveTwoStage, CountsAreWholeBlocks) {
  EXPECT_EQ(whole_blocks(0), 0u);
  EXPECT_EQ(whole_blocks(2.1), 3u);
  for (uint32_t count = 4; count < 5000; ++count) {
    const uint32_t whole = whole_blocks(count);
    EXPECT_LE(std::abs(static_cast<double>(whole) - count), count / 8.0) << count;
    uint32_t blocks = whole;
    while (blocks % 2 == 0 && blocks > 4) blocks /= 2;
    EXPECT_LE(blocks, 7u) << count;
    EXPECT_EQ(whole_blocks(whole), whole);
  }
}

/// A frame whose left half is grey without noise, and whose right half is noisy.
Pilot half_noisy(int width, int height) {
  Pilot pilot{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      pilot.pixels.push_back(x < width / 2 ? PilotPixel{0.5f, 0, false, 16} : PilotPixel{1, 1, true, 16});
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
    for (int x = y % 2; x < 32; x += 2) changed.pixels[static_cast<size_t>(32 * y + x)] = {3, 17, true, 16};
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
  Pilot pilot{64, 64, {}};
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const float sd = x < 32 ? 0.5f : 3.0f;
      pilot.pixels.push_back({1, sd * sd, true, 16});
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
  Pilot one{1, 1, {{1, 1, true, 16}}};
  EXPECT_EQ(two_stage_counts(one, {}, 500), std::vector<float>{500});
  Pilot black{8, 8, std::vector<PilotPixel>(64, PilotPixel{0, 0, true, 16})};
  for (float count : two_stage_counts(black, {}, 500)) EXPECT_EQ(count, 500);
  // A black patch in a noisy frame gets what pixels get on average.
  Pilot patch{32, 32, std::vector<PilotPixel>(1024, PilotPixel{1, 1, true, 16})};
  for (int y = 8; y < 24; ++y) {
    for (int x = 8; x < 24; ++x) patch.pixels[static_cast<size_t>(32 * y + x)] = {0, 0, true, 16};
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
