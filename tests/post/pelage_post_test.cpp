// SPDX-License-Identifier: Apache-2.0
#include "post/pelage_post.h"

#include <gtest/gtest.h>

#include "tests/post/picture.h"

extern "C" {
int host_run(int stereo, int width, int height, const float* rgba, const float* depth, const float* motion_x,
             const float* motion_y, float* out, char message[160]);
int host_stop(const float* four_pixels, float* out, double* seen);
}

namespace pelage {
namespace {

constexpr int kWidth = 30, kHeight = 8;

struct Host {
  std::vector<float> rgba, depth, x, y, out;
  char message[160] = "";
  Host()
      : depth(kWidth * kHeight, 5),
        x(kWidth * kHeight, 4),
        y(kWidth * kHeight, -1),
        out(4 * kWidth * kHeight, -1) {
    for (size_t i = 0; i < 4 * kWidth * kHeight; ++i) rgba.push_back(0.1f + unit_float(hash64(i, 1)));
  }
  int run(bool stereo, int width = kWidth) {
    return host_run(stereo, width, kHeight, rgba.data(), depth.data(), x.data(), y.data(), out.data(),
                    message);
  }
};

TEST(CInterface, BlursFromC) {
  Host host;
  ASSERT_EQ(host.run(false), PELAGE_POST_DONE) << host.message;
  for (int py = 0; py < kHeight - 1; ++py) {
    for (int px = 4; px < kWidth; ++px) {
      for (int c = 0; c < 4; ++c) {
        ASSERT_EQ(host.out[static_cast<size_t>((py * kWidth + px) * 4 + c)],
                  host.rgba[static_cast<size_t>(((py + 1) * kWidth + px - 4) * 4 + c)]);
      }
    }
  }
}

TEST(CInterface, MakesTheOtherEyeFromC) {
  Host host;
  ASSERT_EQ(host.run(true), PELAGE_POST_DONE) << host.message;
  // 100 * 0.5 * (1 / 10 - 1 / 5) = -5 pixels.
  for (int px = 0; px < kWidth - 5; ++px) {
    ASSERT_EQ(host.out[static_cast<size_t>(px) * 4], host.rgba[static_cast<size_t>(px + 5) * 4]) << px;
  }
}

TEST(CInterface, SaysWhatIsWrong) {
  Host host;
  EXPECT_EQ(host.run(false, 0), PELAGE_POST_BAD_ARGUMENT);
  EXPECT_STREQ(host.message, "image: width and height must be 1 to 65535");
  pelage_post_options options;
  pelage_post_defaults(&options);
  EXPECT_EQ(pelage_stereo(nullptr, &options), PELAGE_POST_BAD_ARGUMENT);
  EXPECT_EQ(pelage_stereo(nullptr, nullptr), PELAGE_POST_BAD_ARGUMENT);
  pelage_post_image image{};
  image.size = sizeof image;
  image.width = image.height = 4;
  EXPECT_EQ(pelage_motion_blur(&image, &options), PELAGE_POST_BAD_ARGUMENT);
  EXPECT_STREQ(options.message, "image: motion is missing");
  options.longest_fill = 1 << 30;
  EXPECT_EQ(pelage_motion_blur(&image, &options), PELAGE_POST_BAD_ARGUMENT);
  EXPECT_STREQ(options.message, "longest_fill must be -1 to 65535");
  options.scale = 9;
  EXPECT_EQ(pelage_stereo(&image, &options), PELAGE_POST_BAD_ARGUMENT);
}

TEST(CInterface, StopsWhenTheHostSaysSo) {
  const float pixels[4] = {1, 2, 3, 4};
  float out[4];
  double seen = 0;
  EXPECT_EQ(host_stop(pixels, out, &seen), PELAGE_POST_CANCELLED);
  EXPECT_GT(seen, 0);
}

}  // namespace
}  // namespace pelage
