// SPDX-License-Identifier: Apache-2.0
#include "image/display_image.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "base/temporary_folder.h"
#include "image/image_reader.h"
#include "image/texture_library.h"
#include "image/view_transform.h"

namespace pelage {
namespace {

TEST(ViewTransform, IsTheCurveThatToolsExrToPngComputes) {
  // Computed with `oiiotool --pattern constant:color=X ...` and the arguments in tools/exr_to_png.
  EXPECT_EQ(view_byte(0), 0);
  EXPECT_EQ(view_byte(-1), 0);
  EXPECT_EQ(view_byte(std::nanf("")), 0);
  EXPECT_EQ(view_byte(std::numeric_limits<float>::infinity()), 255);
  EXPECT_EQ(view_byte(1e30f), 255);
  EXPECT_NEAR(view_transform(0.18f), 0.46f, 0.01f) << "middle grey stays where it is";
  float last = 0;
  for (float x = 0; x < 20; x += 0.01f) {
    EXPECT_GE(view_transform(x), last);
    last = view_transform(x);
  }
}

TEST(DisplayImage, IsReadBackAsItWasWritten) {
  const TemporaryFolder folder;
  DisplayImage image{3, 2, {0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 120, 130, 140, 150, 160, 255}};
  write_display_image(folder.path() / "a.png", image);
  const std::string png = read_file(folder.path() / "a.png");
  EXPECT_EQ(png.substr(1, 3), "PNG");
  struct Sink final : ImageSink {
    void begin(const ImageHeader& header) override {
      EXPECT_EQ(header.layout.width, 3);
      EXPECT_EQ(header.layout.height, 2);
      EXPECT_EQ(header.layout.channels, 3);
    }
    void rows(const std::byte* rows, int count) override {
      const auto* bytes = reinterpret_cast<const uint8_t*>(rows);
      pixels.insert(pixels.end(), bytes, bytes + count * 9);
    }
    std::vector<uint8_t> pixels;
  } sink;
  EXPECT_EQ(ImageReader().read(folder.path() / "a.png", sink), "");
  EXPECT_EQ(sink.pixels, image.pixels);
  write_display_image(folder.path() / "a.JPG", image);
  EXPECT_EQ(read_file(folder.path() / "a.JPG").substr(0, 3), "\xff\xd8\xff");
}

TEST(DisplayImage, FormatsGoByTheExtension) {
  for (const char* name : {"a.png", "b.PNG", "c.jpg", "x/d.jpeg"})
    EXPECT_TRUE(is_display_image(name)) << name;
  for (const char* name : {"a.exr", "png", "a.png.exr", ""}) EXPECT_FALSE(is_display_image(name)) << name;
}

TEST(DisplayImage, AFolderThatIsMissingOrFullLeavesNothing) {
  EXPECT_THROW(write_display_image("/proc/none/a.png", {1, 1, {1, 2, 3}}), Error);
  EXPECT_THROW(write_display_image("/dev/full", {1, 1, {1, 2, 3}}), Error);
}

}  // namespace
}  // namespace pelage
