// SPDX-License-Identifier: Apache-2.0
#include "lab/pictures/systematic_error.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/lab/pictures/noisy_pictures.h"

namespace pelage::systematic_error_test {
namespace {

// 512 blocks of 8 x 8 and 32 blocks of 32 x 32 pixels.
constexpr int kWidth = 256, kHeight = 128;
constexpr double kNoise = 0.25;
// A grey 1 has the weight 1 / sqrt(1 + 0.01).
const double kWeight = 1 / std::sqrt(1.01);

ExrImage grey(double value, uint64_t seed, double noise = kNoise) {
  return fur_picture(
      kWidth, kHeight, [&](int, int) { return value; }, noise, seed);
}

TEST(SystematicError, OfNoiseIsZero) {
  const auto error = systematic_error(grey(1, 1), grey(1, 2), grey(1, 3), grey(1, 4), ErrorRegion::kFur);
  ASSERT_TRUE(error);
  // A mean of n^2 pixels varies by (0.25 / n)^2. The product of two differences varies by twice this; its
  // mean over the blocks and channels has 1 / sqrt(1536) or 1 / sqrt(96) of this deviation, of which 5 are
  // allowed.
  EXPECT_LT(error->of_8.rms, std::sqrt(5 * 2 * std::pow(kNoise / 8, 2) / std::sqrt(1536)));
  EXPECT_LT(error->of_32.rms, std::sqrt(5 * 2 * std::pow(kNoise / 32, 2) / std::sqrt(96)));
}

TEST(SystematicError, OfALeakIsItsSize) {
  for (const double leak : {0.05, -0.05}) {
    const auto error =
        systematic_error(grey(1 + leak, 1), grey(1 + leak, 2), grey(1, 3), grey(1, 4), ErrorRegion::kFur);
    // (leak + n)(leak + n') deviates by leak * sqrt(2) n, with n = sqrt(2) * 0.25 / 8, and by n^2; the root
    // of its mean by 1 / (2 leak) of that. 5 deviations.
    EXPECT_NEAR(error->of_8.rms, 0.05 * kWeight, 0.005);
    EXPECT_NEAR(error->of_32.rms, 0.05 * kWeight, 0.004);
  }
  EXPECT_NEAR(
      systematic_error(grey(1.05, 1, 0), grey(1.05, 2, 0), grey(1, 3, 0), grey(1, 4, 0), ErrorRegion::kFur)
          ->of_8.rms,
      0.05 * kWeight, 1e-6);
}

TEST(SystematicError, KnowsTheWorstBlock) {
  for (const double leak : {0.5, -0.5}) {
    const auto leaking = [&](uint64_t seed) {
      return fur_picture(
          kWidth, kHeight, [&](int x, int y) { return 1 + (x / 8 == 5 && y / 8 == 3 ? leak : 0); }, 0.05,
          seed);
    };
    const auto error =
        systematic_error(leaking(1), leaking(2), grey(1, 3, 0.05), grey(1, 4, 0.05), ErrorRegion::kFur);
    // Means of 64 or 1024 pixels and three channels, as differences of two pictures: 5 deviations.
    EXPECT_NEAR(error->of_8.worst, leak * kWeight, 5 * 0.05 / 8 * std::sqrt(2.0 / 3));
    EXPECT_NEAR(error->of_32.worst, leak / 16 * kWeight, 5 * 0.05 / 32 * std::sqrt(2.0 / 3));
  }
}

TEST(SystematicError, TakesNoNoiseForTheWorstBlock) {
  double mean = 0;
  constexpr uint64_t kTimes = 16;
  for (uint64_t i = 0; i < kTimes; ++i) {
    const auto error = systematic_error(grey(1, 4 * i + 1), grey(1, 4 * i + 2), grey(1, 4 * i + 3),
                                        grey(1, 4 * i + 4), ErrorRegion::kFur);
    mean += std::abs(error->of_8.worst) / kTimes;
  }
  // The larger of two normal numbers is 1.13 deviations on average, and varies by 0.6: the mean of 16 is
  // below 1.9 (5 deviations). The largest of 512 numbers would be 3.
  EXPECT_LT(mean, 1.9 * kNoise / 8 * std::sqrt(2.0 / 3));
}

TEST(SystematicError, CountsBlocksThatBothReferencesMostlyShow) {
  ExrImage a = grey(1, 3, 0), b = grey(1, 4, 0);
  const auto hide = [](ExrImage& image, int from, int to) {
    for (ExrChannel& channel : image.channels) {
      if (channel.name != "tangent.X") continue;
      for (size_t p = 0; p < channel.pixels.size(); ++p) {
        const int x = static_cast<int>(p) % kWidth;
        if (from <= x && x < to) channel.pixels[p] = 0.2f;  // a square of 0.04
      }
    }
  };
  hide(a, 0, 64);
  hide(b, 64, 68);  // half of a block
  const auto x = fur_picture(
      kWidth, kHeight, [](int at, int) { return at < 72 ? 3 : 1; }, 0, 1);
  EXPECT_EQ(systematic_error(x, x, a, b, ErrorRegion::kFur)->of_8.rms, 0);
  EXPECT_GT(systematic_error(x, x, a, b, ErrorRegion::kSurfaces)->of_8.rms, 0.5);
  hide(a, 0, kWidth);
  EXPECT_TRUE(std::isnan(systematic_error(x, x, a, b, ErrorRegion::kFur)->of_8.rms));
  EXPECT_FALSE(systematic_error(x, ExrImage{}, a, b, ErrorRegion::kFur));
}

}  // namespace
}  // namespace pelage::systematic_error_test
