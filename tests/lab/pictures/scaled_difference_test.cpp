// SPDX-License-Identifier: Apache-2.0
#include "lab/pictures/scaled_difference.h"

#include <gtest/gtest.h>

#include "base/temporary_folder.h"

namespace pelage {
namespace {

ExrImage two_pixels(float left, float right) {
  ExrImage image;
  image.width = 2;
  image.height = 1;
  float brightness = 1;
  for (const char* name : {"R", "G", "B"}) {
    image.channels.push_back({name, ChannelType::kFloat, {brightness * left, brightness * right}, {}});
    brightness /= 2;
  }
  return image;
}

TEST(ScaledDifference, IsGreyWhereMeansAreEqual) {
  const auto picture = scaled_difference({two_pixels(1, 3), two_pixels(3, 1)},
                                         {two_pixels(2, 2.5f), two_pixels(2, 1.5f)}, 10, "caption");
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->caption, "caption");
  EXPECT_EQ(picture->width, 2);
  EXPECT_EQ(picture->height, 1);
  EXPECT_EQ(picture->channels, 3);
  EXPECT_EQ(picture->pixels, std::vector<unsigned char>(6, 128));
}

TEST(ScaledDifference, HasTheSignOfThePicture) {
  // Red differs by 0.01 and -0.09, green by half, blue by a quarter.
  const auto picture = scaled_difference({two_pixels(0.51f, 0.41f)}, {two_pixels(0.5f, 0.5f)}, 10, "");
  ASSERT_TRUE(picture);
  // 255 (0.5 + 0.1), 255 (0.5 + 0.05), and so on; 255 (0.5 - 0.9) is clipped.
  EXPECT_EQ(picture->pixels, (std::vector<unsigned char>{153, 140, 134, 0, 13, 70}));
}

TEST(ScaledDifference, IsEmptyWithoutPicturesOfOneSize) {
  const ExrImage image = two_pixels(1, 1);
  ExrImage wide = image, grey = image;
  wide.width = 3;
  grey.channels.pop_back();
  EXPECT_FALSE(scaled_difference({}, {image}, 10, ""));
  EXPECT_FALSE(scaled_difference({image}, {}, 10, ""));
  EXPECT_FALSE(scaled_difference({image}, {wide}, 10, ""));
  EXPECT_FALSE(scaled_difference({image}, {grey}, 10, ""));
  const TemporaryFolder folder;
  EXPECT_FALSE(
      scaled_difference_of_files({folder.path() / "none.exr"}, {folder.path() / "none.exr"}, 10, ""));
  write_exr(folder.path() / "a.exr", image);
  EXPECT_TRUE(scaled_difference_of_files({folder.path() / "a.exr"}, {folder.path() / "a.exr"}, 10, ""));
}

}  // namespace
}  // namespace pelage
