// SPDX-License-Identifier: Apache-2.0
#include "lab/pictures/picture_error.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "tests/lab/pictures/noisy_pictures.h"

namespace pelage {
namespace {

/// 4 x 2 pixels of grey; the upper row is empty.
ExrImage picture(float grey, float error) {
  ExrImage image;
  image.width = 4;
  image.height = 2;
  for (const char* name : {"R", "G", "B"}) {
    image.channels.push_back({name, ChannelType::kFloat, std::vector<float>(8, 0.5f), {}});
    for (size_t i = 4; i < 8; ++i) image.channels.back().pixels[i] = grey + (i % 2 ? error : -error);
  }
  image.channels.push_back({"A", ChannelType::kFloat, {0, 0, 0, 0, 1, 1, 0.5f, 0.5f}, {}});
  image.channels.push_back({"samples", ChannelType::kUint, {}, {4, 4, 4, 4, 16, 16, 64, 64}});
  return image;
}

TEST(PictureError, IsRelativeToTheTruthOnSurfaces) {
  const ExrImage truth = picture(1, 0);
  const auto error = picture_error(picture(1, 0.1f), truth, truth, ErrorRegion::kSurfaces);
  ASSERT_TRUE(error);
  // t is the mean over 9 rows: the upper row and its copies above the border are 4 of them.
  const double t = (4 * 0.5 + 5 * 1) / 9, m = t;
  EXPECT_NEAR(error->rel_mse, 0.01 / (t * t + 0.01 * m * m), 1e-6);
  EXPECT_NEAR(error->bias, 0, 1e-6);
  EXPECT_DOUBLE_EQ(error->coverage, 3.0 / 8);
  EXPECT_DOUBLE_EQ(error->region_share, 0.5);
  EXPECT_DOUBLE_EQ(error->samples, 22);
  EXPECT_DOUBLE_EQ(error->region_samples, 40);
  EXPECT_FALSE(picture_error(truth, truth, ExrImage{}, ErrorRegion::kSurfaces));
  EXPECT_FALSE(picture_error(truth, truth, truth, ErrorRegion::kFur)) << "no layer `tangent`";
}

constexpr int kWidth = 303, kHeight = 202;
constexpr double kVariance = 0.25;  // of a pixel of grey 1

/// A grey picture with fur in a disc. Each pixel is the mean of four exponential random numbers, so its noise
/// is as skewed as the noise of a picture with few samples.
ExrImage noisy(uint64_t seed, float grey) {
  ExrImage image;
  image.width = kWidth;
  image.height = kHeight;
  const size_t pixels = size_t{kWidth} * kHeight;
  uint64_t draw = 0;
  for (const char* name : {"R", "G", "B"}) {
    image.channels.push_back({name, ChannelType::kFloat, std::vector<float>(pixels, 0.0f), {}});
    for (float& value : image.channels.back().pixels) {
      for (int i = 0; i < 4; ++i) value -= grey / 4 * std::log(1 - unit_float(hash64(seed, draw++)));
    }
  }
  image.channels.push_back({"A", ChannelType::kFloat, std::vector<float>(pixels, 1.0f), {}});
  for (const char* name : {"tangent.X", "tangent.Y", "tangent.Z"}) {
    image.channels.push_back({name, ChannelType::kFloat, std::vector<float>(pixels, 0.0f), {}});
    const bool is_y = std::string(name) == "tangent.Y";
    for (size_t p = 0; p < pixels; ++p) {
      const double x = static_cast<double>(p % kWidth) - 180, y = static_cast<double>(p / kWidth) - 90;
      if (is_y && x * x + y * y < 150 * 150) image.channels.back().pixels[p] = -1;
    }
  }
  return image;
}

/// A picture whose channels and places differ, so that a mistake in either shows.
ExrImage coloured(uint64_t seed) {
  ExrImage image = noisy(seed, 1);
  for (size_t c = 0; c < 3; ++c) {
    for (size_t p = 0; p < image.channels[c].pixels.size(); ++p)
      image.channels[c].pixels[p] *= 0.02f * static_cast<float>(c + 1) * static_cast<float>(p % kWidth % 97);
  }
  return image;
}

/// Mean of a channel over whole squares of `size` pixels, with all loops at once.
struct NaiveChannel {
  const ExrImage& image;
  const char* name;
  int size;

  double at(int x, int y) const {
    double sum = 0;
    for (int v = 0; v < size; ++v) {
      for (int u = 0; u < size; ++u)
        sum += image.find(name)->pixels[static_cast<size_t>((y * size + v) * image.width + x * size + u)];
    }
    return sum / (size * size);
  }
};

double naive_t(const NaiveChannel& a, const NaiveChannel& b, int x, int y, int around) {
  double sum = 0;
  for (int v = y - around; v <= y + around; ++v) {
    for (int u = x - around; u <= x + around; ++u) {
      const int in_x = std::min(std::max(u, 0), kWidth / a.size - 1),
                in_y = std::min(std::max(v, 0), kHeight / a.size - 1);
      sum += (a.at(in_x, in_y) + b.at(in_x, in_y)) / 2;
    }
  }
  return sum / ((2 * around + 1) * (2 * around + 1));
}

bool naive_is_fur(const ExrImage& image, int x, int y, int size) {
  return -NaiveChannel{image, "tangent.Y", size}.at(x, y) > 0.5;
}

double naive_rel_mse(const ExrImage& x, const ExrImage& a, const ExrImage& b, int size, int around) {
  double sum = 0, count = 0;
  for (const char* name : {"R", "G", "B"}) {
    const NaiveChannel cx{x, name, size}, ca{a, name, size}, cb{b, name, size};
    double m = 0, fur = 0;
    for (int v = 0; v < kHeight / size; ++v) {
      for (int u = 0; u < kWidth / size; ++u) {
        if (!naive_is_fur(a, u, v, size)) continue;
        m += naive_t(ca, cb, u, v, around);
        ++fur;
      }
    }
    m /= fur;
    for (int v = 0; v < kHeight / size; ++v) {
      for (int u = 0; u < kWidth / size; ++u) {
        if (!naive_is_fur(a, u, v, size)) continue;
        const double t = naive_t(ca, cb, u, v, around);
        sum += (cx.at(u, v) - ca.at(u, v)) * (cx.at(u, v) - cb.at(u, v)) / (t * t + 0.01 * m * m);
        ++count;
      }
    }
  }
  return sum / count;
}

TEST(PictureError, IsThatOfNaiveLoops) {
  const ExrImage x = coloured(1), a = coloured(2), b = coloured(3);
  const auto error = picture_error(x, a, b, ErrorRegion::kFur);
  ASSERT_TRUE(error);
  // Sums of 150,000 numbers in another order, in double precision.
  EXPECT_NEAR(error->rel_mse / naive_rel_mse(x, a, b, 1, 4), 1, 1e-9);
  EXPECT_NEAR(error->rel_mse_4 / naive_rel_mse(x, a, b, 4, 1), 1, 1e-9);
  EXPECT_NEAR(error->rel_mse_16 / naive_rel_mse(x, a, b, 16, 1), 1, 1e-9);
}

TEST(PictureError, CountsNoNoiseOfTheReferences) {
  const ExrImage a = noisy(1, 1), b = noisy(2, 1), x = noisy(3, 1);
  for (const ErrorRegion region : {ErrorRegion::kSurfaces, ErrorRegion::kFur}) {
    const auto error = picture_error(x, a, b, region);
    // (x - a)(x - b) varies by 3 to 4 times the variance of a pixel: 5 deviations of the mean over 120,000
    // numbers and more are 0.014. The noise of t adds 3 * 0.25 / (2 * 81).
    EXPECT_NEAR(error->rel_mse, kVariance / 1.01, 0.02);
    EXPECT_NEAR(error->rel_mse_4, kVariance / 16 / 1.01, 0.004);
    EXPECT_NEAR(error->rel_mse_16, kVariance / 256 / 1.01, 0.0005);
    EXPECT_NEAR(error->bias, 0, 0.01);
  }
}

TEST(PictureError, OfFourPicturesCountsNoNoise) {
  const ExrImage a = noisy(1, 1), b = noisy(2, 1);
  // The variance of a pixel is 0.25; the deviation of the mean over all pixels and channels is 0.0006.
  const auto none = picture_error(noisy(3, 1), noisy(4, 1), a, b, ErrorRegion::kFur);
  EXPECT_NEAR(none->rel_mse, 0, 0.003);
  const auto brighter = picture_error(noisy(3, 1.2f), noisy(4, 1.2f), a, b, ErrorRegion::kFur);
  EXPECT_NEAR(brighter->rel_mse, 0.04, 0.004);
  EXPECT_NEAR(brighter->bias, 0.2, 0.01);
  const auto darker = picture_error(noisy(3, 0.8f), noisy(4, 0.8f), a, b, ErrorRegion::kFur);
  EXPECT_NEAR(darker->rel_mse, 0.04, 0.004);
  EXPECT_NEAR(darker->bias, -0.2, 0.01);
}

TEST(PictureError, KnowsItsStandardError) {
  double squares = 0, stated = 0, mean = 0;
  constexpr int kTimes = 24;
  for (uint64_t i = 0; i < kTimes; ++i) {
    const auto error = picture_error(noisy(4 * i + 10, 1), noisy(4 * i + 11, 1), noisy(4 * i + 12, 1),
                                     noisy(4 * i + 13, 1), ErrorRegion::kFur);
    mean += error->rel_mse / kTimes;
    squares += error->rel_mse * error->rel_mse / kTimes;
    stated += error->rel_mse_deviation * error->rel_mse_deviation / kTimes;
  }
  EXPECT_NEAR(mean, 0, 4 * std::sqrt(stated / kTimes));
  // Chi-square of 24 degrees of freedom, 99.9 %: 0.35 to 2.1.
  EXPECT_GT(squares / stated, 0.35);
  EXPECT_LT(squares / stated, 2.1);
}

TEST(PictureError, KnowsTheErrorThatOnePixelInAThousandExceeds) {
  const auto one_in = [](int count) {
    return fur_picture(
        300, 200, [&](int x, int y) { return (300 * y + x) % count == 7 ? 3 : 1; }, 0, 1);
  };
  const ExrImage truth = one_in(1000000);
  const auto top = [&](int count) {
    return picture_error(one_in(count), truth, truth, ErrorRegion::kFur)->top_error;
  };
  EXPECT_NEAR(top(500), 2 / std::sqrt(1.01), 0.001);
  EXPECT_EQ(top(2000), 0);
  // References without a firefly do not get one from the picture, nor does one reference alone make an error.
  EXPECT_EQ(picture_error(truth, one_in(100), truth, ErrorRegion::kFur)->top_error, 0);
}

TEST(PictureError, IsUnknownWithoutFur) {
  ExrImage bald = noisy(1, 1);
  for (ExrChannel& channel : bald.channels) {
    if (channel.name == "tangent.Y") channel.pixels.assign(channel.pixels.size(), 0);
  }
  const auto error = picture_error(noisy(2, 1), bald, noisy(3, 1), ErrorRegion::kFur);
  ASSERT_TRUE(error);
  EXPECT_TRUE(std::isnan(error->rel_mse));
  EXPECT_TRUE(std::isnan(error->rel_mse_4));
  EXPECT_TRUE(std::isnan(error->rel_mse_16));
  EXPECT_TRUE(std::isnan(error->top_error));
  EXPECT_EQ(error->region_share, 0);
}

/// Samples of variance 1, 1, 4, 4: counts in proportion to 1, 1, 2, 2 leave 2.25 where equal ones leave 2.5.
TEST(PictureError, KnowsWhatKnowingTheVarianceWouldSave) {
  ExrImage image = picture(1, 0);
  EXPECT_TRUE(std::isnan(best_gain(image).all));
  image.channels.push_back({"noise", ChannelType::kFloat, {0, 0, 0, 0, 0.25f, 0.25f, 0.25f, 0.25f}, {}});
  const BestGain gain = best_gain(image);
  EXPECT_NEAR(gain.surface, 2.5 / 2.25, 1e-6);
  EXPECT_NEAR(gain.all, 2 * 2.5 / 2.25, 1e-6);
}

}  // namespace
}  // namespace pelage
