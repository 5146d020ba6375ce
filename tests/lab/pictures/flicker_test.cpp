// SPDX-License-Identifier: Apache-2.0
#include "lab/pictures/flicker.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "tests/lab/pictures/noisy_pictures.h"

namespace pelage::flicker_test {
namespace {

constexpr int kWidth = 256, kHeight = 128, kFrames = 8;
constexpr double kNoise = 0.25;
const double kWeight = 1 / std::sqrt(1.01);
// Deviation of the change of a mean of 64 pixels and three channels.
const double kNoiseFlicker = kNoise * std::sqrt(2.0 / (64 * 3));

/// `value` depends on the frame, x and y. Each frame has noise of its own.
std::vector<FrameBlocks> sequence(const std::function<double(int frame, int x, int y)>& value, double noise,
                                  uint64_t seed) {
  std::vector<FrameBlocks> frames;
  for (int frame = 0; frame < kFrames; ++frame) {
    const ExrImage image = fur_picture(
        kWidth, kHeight, [&](int x, int y) { return value(frame, x, y); }, noise,
        seed * kFrames + static_cast<uint64_t>(frame));
    frames.push_back(*frame_blocks(image, ErrorRegion::kFur));
  }
  return frames;
}

double still(int, int, int) { return 1; }
/// The camera moves by one pixel per frame.
double panning(int frame, int x, int y) { return 1 + 0.5 * std::sin(0.2 * (x + frame)) * std::cos(0.1 * y); }

TEST(Flicker, OfMovingNoiseIsItsChange) {
  const double found =
      flicker(sequence(still, kNoise, 1), sequence(still, kNoise, 2), sequence(still, kNoise, 3));
  // The mean of 3584 products with the noise of three pictures: 5 deviations are 12 %.
  EXPECT_NEAR(found / (kNoiseFlicker * kWeight), 1, 0.12);
}

TEST(Flicker, OfAPanIsZero) {
  const auto pan = sequence(panning, 0, 1);
  EXPECT_EQ(flicker(pan, pan, pan), 0);
  // The product of the noise of two references deviates by the square of the change of one, the mean of 3584
  // products by 1 / 60 of this. 5 deviations.
  EXPECT_LT(flicker(pan, sequence(panning, kNoise, 2), sequence(panning, kNoise, 3)),
            kNoiseFlicker * std::sqrt(5.0 / 60) / 0.5);
}

TEST(Flicker, OfAStillErrorIsZero) {
  const auto reference = sequence(still, 0, 1);
  EXPECT_EQ(flicker(sequence([](int, int, int) { return 1.5; }, 0, 2), reference, reference), 0);
}

TEST(Flicker, OfPulsingLightIsItsChange) {
  const auto reference = sequence(still, 0, 1);
  const auto pulse = sequence([](int frame, int, int) { return frame % 2 ? 1.05 : 0.95; }, 0, 2);
  EXPECT_NEAR(flicker(pulse, reference, reference), 0.1 * kWeight, 1e-6);
}

TEST(Flicker, IsUnknownWithoutFramesThatMatch) {
  auto reference = sequence(still, 0, 1);
  const auto other = reference;
  reference.pop_back();
  EXPECT_TRUE(std::isnan(flicker(other, reference, other)));
  EXPECT_TRUE(std::isnan(flicker({}, {}, {})));
  EXPECT_FALSE(frame_blocks(ExrImage{}, ErrorRegion::kFur));
  EXPECT_TRUE(std::isnan(flicker_of_files({"none.exr"}, {"none.exr"}, {"none.exr"}, ErrorRegion::kFur)));
}

}  // namespace
}  // namespace pelage::flicker_test
