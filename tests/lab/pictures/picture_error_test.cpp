// SPDX-License-Identifier: Apache-2.0
#include "lab/pictures/picture_error.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/hash.h"

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
  const auto error = picture_error(picture(1, 0.1f), truth, truth);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->rel_mse, 0.01 / 1.01, 1e-6);
  EXPECT_NEAR(error->bias, 0, 1e-6);
  EXPECT_DOUBLE_EQ(error->coverage, 3.0 / 8);
  EXPECT_DOUBLE_EQ(error->surface_share, 0.5);
  EXPECT_DOUBLE_EQ(error->samples, 22);
  EXPECT_DOUBLE_EQ(error->surface_samples, 40);
  EXPECT_FALSE(picture_error(truth, truth, ExrImage{}));
}

/// Grey whose noise is as skewed as that of few samples: four exponential numbers per pixel.
ExrImage noisy(uint64_t seed, float grey) {
  ExrImage image;
  image.width = 300;
  image.height = 200;
  const size_t pixels = 60000;
  uint64_t draw = 0;
  for (const char* name : {"R", "G", "B"}) {
    image.channels.push_back({name, ChannelType::kFloat, std::vector<float>(pixels, 0.0f), {}});
    for (float& value : image.channels.back().pixels) {
      for (int i = 0; i < 4; ++i) value -= grey / 4 * std::log(1 - unit_float(hash64(seed, draw++)));
    }
  }
  image.channels.push_back({"A", ChannelType::kFloat, std::vector<float>(pixels, 1.0f), {}});
  return image;
}

TEST(PictureError, OfFourPicturesCountsNoNoise) {
  const ExrImage a = noisy(1, 1), b = noisy(2, 1);
  // The variance of a pixel is 0.25; the deviation of the mean over all pixels and channels is 0.0006.
  const auto none = picture_error(noisy(3, 1), noisy(4, 1), a, b);
  EXPECT_NEAR(none->rel_mse, 0, 0.003);
  const auto brighter = picture_error(noisy(3, 1.2f), noisy(4, 1.2f), a, b);
  EXPECT_NEAR(brighter->rel_mse, 0.04, 0.004);
  EXPECT_NEAR(brighter->bias, 0.2, 0.01);
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
