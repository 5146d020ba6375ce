// SPDX-License-Identifier: Apache-2.0
// PNG files that a few lines of this test write, read by read_plain_png() and by OpenImageIO.
#include "image/plain_png.h"

#include <array>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "base/file.h"
#include "base/hash.h"
#include "base/temporary_folder.h"
#include "image/image_reader.h"
#include "tests/image/kept_image.h"

namespace pelage {
namespace {

struct Picture {
  uint32_t width = 37, height = 23;
  int color = 2, bits = 8, interlace = 0;
  size_t idat = 100;        // bytes of a chunk of pixels
  std::string before = "";  // further chunks, before the pixels
};

std::string four_bytes(uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
          static_cast<char>(value)};
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string checked = type + data;
  const auto sum = ::crc32(0, reinterpret_cast<const Bytef*>(checked.data()), uInt(checked.size()));
  return four_bytes(static_cast<uint32_t>(data.size())) + checked + four_bytes(static_cast<uint32_t>(sum));
}

/// Random rows, each with one of the five filters. What a filter means to a decoder does not matter here: any
/// bytes are a picture.
std::string png(const Picture& p) {
  const size_t channels = (p.color & 2 ? 3 : 1) + (p.color & 4 ? 1 : 0);
  const size_t row = p.width * channels * size_t(p.bits) / 8;
  std::string raw;
  for (uint32_t y = 0; y < p.height; ++y) {
    raw += static_cast<char>(y % 5);
    for (size_t i = 0; i < row; ++i) raw += static_cast<char>(hash64(y, i, size_t(p.color), size_t(p.bits)));
  }
  std::string packed(::compressBound(uLong(raw.size())), '\0');
  uLongf size = uLongf(packed.size());
  ::compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(raw.data()),
             uLong(raw.size()));
  packed.resize(size);
  std::string file = std::string("\x89PNG\r\n\x1a\n") +
                     chunk("IHDR", four_bytes(p.width) + four_bytes(p.height) +
                                       std::string{char(p.bits), char(p.color), 0, 0, char(p.interlace)}) +
                     p.before;
  for (size_t at = 0; at < packed.size(); at += p.idat) file += chunk("IDAT", packed.substr(at, p.idat));
  return file + chunk("IEND", "");
}

class PlainPngTest : public testing::Test {
 protected:
  std::optional<std::string> read(const std::string& bytes, KeptImage& kept,
                                  const std::string& name = "a.png") {
    write_file(folder_.path() / name, bytes);
    return read_plain_png(folder_.path() / name, kept);
  }
  TemporaryFolder folder_;
};

TEST_F(PlainPngTest, TexelsAreThoseOfOpenImageIo) {
  const ImageReader reader;
  for (const int color : {0, 2, 4, 6}) {
    for (const int bits : {8, 16}) {
      Picture picture;
      picture.color = color, picture.bits = bits;
      picture.before = chunk("gAMA", four_bytes(45455)) + chunk("tEXt", std::string("a\0b", 3));
      KeptImage own, other;
      EXPECT_EQ(read(png(picture), own), "") << color << " " << bits;
      EXPECT_EQ(reader.read(folder_.path() / "a.png", other), "");
      EXPECT_EQ(own.begun, 1);
      EXPECT_EQ(own.header.layout.width, other.header.layout.width);
      EXPECT_EQ(own.header.layout.height, other.header.layout.height);
      EXPECT_EQ(own.header.layout.channels, other.header.layout.channels);
      EXPECT_EQ(own.header.layout.kind, other.header.layout.kind);
      EXPECT_EQ(own.header.is_integer, other.header.is_integer);
      EXPECT_TRUE(own.texels == other.texels) << color << " " << bits;
    }
  }
}

TEST_F(PlainPngTest, OtherFilesAreLeftToOpenImageIo) {
  const auto is_left = [&](const std::string& bytes, const std::string& name = "a.png") {
    KeptImage kept;
    return !read(bytes, kept, name) && kept.begun == 0;
  };
  EXPECT_FALSE(is_left(png({})));
  EXPECT_FALSE(is_left(png({}), "b.PNG"));
  EXPECT_TRUE(is_left(png({}), "a.tif"));
  EXPECT_TRUE(is_left(""));
  EXPECT_TRUE(is_left("GIF89a"));
  EXPECT_TRUE(is_left(png({.bits = 4})));
  EXPECT_TRUE(is_left(png({.color = 3})));
  EXPECT_TRUE(is_left(png({.interlace = 1})));
  EXPECT_TRUE(is_left(png({.before = chunk("tRNS", std::string(6, '\0'))})));
  EXPECT_TRUE(is_left(png({.before = chunk("PLTE", "abc")})));
  EXPECT_TRUE(is_left(png({.width = 0})));
  EXPECT_TRUE(is_left(png({.width = 100'000, .height = 1})));
  std::string wrong = png({});
  wrong[20] ^= 1;  // the width, whose checksum is then wrong
  EXPECT_TRUE(is_left(wrong));
}

TEST_F(PlainPngTest, DamageIsFound) {
  const std::string whole = png({});
  KeptImage good;
  ASSERT_EQ(read(whole, good), "");
  size_t found = 0, tried = 0;
  for (size_t at = 33; at < whole.size() - 12; at += 11) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << hash64(at) % 8));
    for (const std::string& bytes : {flipped, whole.substr(0, at)}) {
      KeptImage kept;
      const std::optional<std::string> damage = read(bytes, kept);
      ++tried;
      if (damage && damage->empty()) {
        EXPECT_TRUE(kept.texels == good.texels) << at;  // in what comes after the last row
      } else {
        ++found;
      }
    }
  }
  EXPECT_GT(found, tried * 9 / 10);
}

TEST_F(PlainPngTest, ASinkMayStop) {
  class Stopping final : public ImageSink {
    void begin(const ImageHeader&) override {}
    void rows(const std::byte*, int) override { throw std::runtime_error("enough"); }
  } sink;
  write_file(folder_.path() / "a.png", png({}));
  EXPECT_THROW(read_plain_png(folder_.path() / "a.png", sink), std::runtime_error);
}

}  // namespace
}  // namespace pelage
