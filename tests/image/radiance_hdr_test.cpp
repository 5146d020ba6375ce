// SPDX-License-Identifier: Apache-2.0
// Radiance files that a few lines of this test write, read by read_radiance_hdr() and by OpenImageIO.
#include "image/radiance_hdr.h"

#include <cmath>
#include <cstring>
#include <stdexcept>

#include <gtest/gtest.h>

#include "base/file.h"
#include "base/hash.h"
#include "base/temporary_folder.h"
#include "image/image_reader.h"
#include "tests/image/kept_image.h"
#include "tests/support/data.h"

namespace pelage {
namespace {

std::string header(const std::string& axes) {
  return "#?RADIANCE\n# comment\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n" + axes + "\n";
}
std::string header(size_t width, size_t height) {
  return header("-Y " + std::to_string(height) + " +X " + std::to_string(width));
}

/// Any exponent of an image of light; OpenImageIO 2.4.7 rounds the powers of two of 40, 223 and 226.
char exponent(uint64_t random) { return static_cast<char>(random % 9 == 0 ? 0 : 64 + random % 128); }

/// None of them is (1, 1, 1, n).
std::string plain_pixels(size_t count) {
  std::string pixels;
  for (size_t i = 0; i < count; ++i) {
    for (size_t c = 0; c < 3; ++c) pixels += static_cast<char>(3 + hash64(i, c) % 253);
    pixels += exponent(i);
  }
  return pixels;
}

/// Rows whose channels are runs of random lengths, repeated and literal ones in turn.
std::string coded_rows(size_t width, size_t height) {
  std::string rows;
  for (size_t y = 0; y < height; ++y) {
    rows += std::string{2, 2, static_cast<char>(width >> 8), static_cast<char>(width)};
    for (size_t c = 0; c < 4; ++c) {
      for (size_t x = 0; x < width;) {
        const uint64_t random = hash64(x, y, c);
        const bool repeats = random & 1;
        const size_t count = std::min<size_t>(width - x, 1 + (random >> 1) % (repeats ? 127 : 128));
        rows += static_cast<char>(repeats ? 128 + count : count);
        for (size_t i = 0; i < (repeats ? 1 : count); ++i) {
          const uint64_t value = random >> (8 + i % 40);
          rows += c == 3 ? exponent(value) : static_cast<char>(value);
        }
        x += count;
      }
    }
  }
  return rows;
}

class RadianceHdrTest : public testing::Test {
 protected:
  std::optional<std::string> read(const std::string& bytes, KeptImage& kept) {
    write_file(file_, bytes);
    return read_radiance_hdr(file_, kept);
  }
  /// What is wrong with a file; "left" if it is left to OpenImageIO.
  std::string problem(const std::string& bytes) {
    KeptImage kept;
    const std::optional<std::string> damage = read(bytes, kept);
    EXPECT_TRUE(damage || kept.begun == 0);
    return damage.value_or("left");
  }
  static void expect_same(const std::filesystem::path& file) {
    KeptImage own, other;
    EXPECT_EQ(read_radiance_hdr(file, own), "") << file;
    EXPECT_EQ(ImageReader().read(file, other), "") << file;
    EXPECT_EQ(own.header.layout.width, other.header.layout.width);
    EXPECT_EQ(own.header.layout.height, other.header.layout.height);
    EXPECT_EQ(own.header.layout.channels, other.header.layout.channels);
    EXPECT_EQ(own.header.layout.kind, other.header.layout.kind);
    EXPECT_EQ(own.header.is_integer, other.header.is_integer);
    EXPECT_EQ(own.texels.size(), own.header.layout.bytes());
    EXPECT_TRUE(own.texels == other.texels) << file;
  }
  TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "a.hdr";
};

TEST_F(RadianceHdrTest, TexelsAreThoseOfOpenImageIo) {
  for (const size_t width : {1, 7, 8, 300, 32767}) {
    write_file(file_, header(width, 5) + plain_pixels(5 * width));
    expect_same(file_);
    if (width < 8) continue;
    write_file(file_, header(width, 9) + coded_rows(width, 8) + plain_pixels(width));
    expect_same(file_);
  }
  write_file(file_, header(40000, 3) + plain_pixels(3 * 40000));  // too wide for runs
  expect_same(file_);
}

TEST_F(RadianceHdrTest, EveryExponentIsExact) {
  std::string pixels;
  for (int e = 0; e < 256; ++e) pixels += std::string{'\x65', '\xff', '\0', static_cast<char>(e)};
  KeptImage kept;
  ASSERT_EQ(read(header(256, 1) + pixels, kept), "");
  for (int e = 0; e < 256; ++e) {
    float rgb[3];
    std::memcpy(rgb, kept.texels.data() + static_cast<size_t>(e) * sizeof rgb, sizeof rgb);
    EXPECT_EQ(rgb[0], e == 0 ? 0 : std::ldexp(0x65, e - 136)) << e;
    EXPECT_EQ(rgb[1], e == 0 ? 0 : std::ldexp(0xff, e - 136)) << e;
    EXPECT_EQ(rgb[2], 0) << e;
  }
}

TEST_F(RadianceHdrTest, RealEnvironmentsAreThoseOfOpenImageIo) {
  PELAGE_REQUIRE_DATA();
  for (const char* name : {"studio_small_03_1k.hdr", "venice_sunset_1k.hdr"})
    expect_same(data_folder() / "env" / name);
}

TEST_F(RadianceHdrTest, OldRunsRepeatThePixelBefore) {
  const auto old_run = [](int count) { return std::string("\1\1\1") + static_cast<char>(count); };
  const std::string pixel = "\x40\x80\xc0\x80";
  KeptImage runs, plain;
  ASSERT_EQ(read(header(270, 1) + pixel + old_run(2) + old_run(1) + "abc\x80" + old_run(10), runs), "");
  std::string pixels;
  for (size_t x = 0; x < 259; ++x) pixels += pixel;
  for (size_t x = 259; x < 270; ++x) pixels += "abc\x80";
  ASSERT_EQ(read(header(270, 1) + pixels, plain), "");
  EXPECT_TRUE(runs.texels == plain.texels);
  EXPECT_EQ(problem(header(4, 1) + old_run(4)), "is damaged: a run does not fit its row");
  EXPECT_EQ(problem(header(4, 1) + pixel + old_run(4)), "is damaged: a run does not fit its row");
  EXPECT_EQ(problem(header(4, 1) + pixel + old_run(0) + old_run(0) + old_run(0) + old_run(1)),
            "is damaged: a run does not fit its row");
}

TEST_F(RadianceHdrTest, DamageIsNamed) {
  const std::string start = header(8, 1), runs = std::string("\2\2\0\10", 4);
  EXPECT_EQ(problem(start + runs +
                    "\x89"
                    "a"),
            "is damaged: a run does not fit its row");
  EXPECT_EQ(problem(start + runs +
                    "\x87"
                    "a\2bc"),
            "is damaged: a run does not fit its row");
  EXPECT_EQ(problem(start + runs +
                    std::string("\0\x88"
                                "a",
                                3)),
            "is damaged: a run does not fit its row");
  EXPECT_EQ(problem(start + std::string("\2\2\0\11", 4)), "is damaged: a row has another width");
  for (const char* axes : {"+Y 4 +X 4", "-Y 4 -X 4", "+X 4 -Y 4", "-X 4 +Y 4"}) {
    EXPECT_EQ(problem(header(axes) + plain_pixels(16)),
              std::string("has the axes '") + axes + "'; Pelage reads only -Y HEIGHT +X WIDTH");
  }
  for (const std::string& whole : {header(20, 6) + coded_rows(20, 6), header(5, 6) + plain_pixels(30)}) {
    EXPECT_EQ(problem(whole), "");
    EXPECT_EQ(problem(whole + "more"), "");
    const size_t begin = whole.find('\n', whole.find("-Y")) + 1;
    for (size_t size = 0; size < whole.size(); size += size + 1 == begin ? 1 : 5)
      EXPECT_EQ(problem(whole.substr(0, size)), size < begin ? "left" : "is truncated") << size;
  }
}

TEST_F(RadianceHdrTest, OtherFilesAreLeftToOpenImageIo) {
  EXPECT_EQ(problem(""), "left");
  EXPECT_EQ(problem("\x89PNG\r\n\x1a\n"), "left");
  EXPECT_EQ(problem("#?RADIANCE\n\n-Y 1 +X 1\nabcd"), "left");
  EXPECT_EQ(problem("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd"), "left");
  EXPECT_EQ(problem("#?RADIANCE\n" + std::string(100'000, 'x')), "left");
  EXPECT_EQ(problem("#?RADIANCE\n" + std::string(100'000, 'x') + "\nFORMAT=32-bit_rle_rgbe\n\n"), "left");
  for (const char* axes :
       {"", "-Y 4", "-Y 0 +X 4", "-Y 4 +X -4", "-Y 65537 +X 1", "-Y 1 +X 99999999999999999999"})
    EXPECT_EQ(problem(header(axes) + "abcd"), "left") << axes;
  KeptImage kept;
  EXPECT_FALSE(read_radiance_hdr(folder_.path() / "none.hdr", kept));
}

TEST_F(RadianceHdrTest, ASinkMayStop) {
  class Stopping final : public ImageSink {
    void begin(const ImageHeader&) override {}
    void rows(const std::byte*, int) override { throw std::runtime_error("enough"); }
  } sink;
  write_file(file_, header(2, 2) + plain_pixels(4));
  EXPECT_THROW(read_radiance_hdr(file_, sink), std::runtime_error);
}

}  // namespace
}  // namespace pelage
