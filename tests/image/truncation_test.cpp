// SPDX-License-Identifier: Apache-2.0
#include "image/truncation.h"

#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "base/file.h"
#include "tests/support/data.h"

namespace pelage {
namespace {

using namespace std::string_literals;

// Segments as a JPEG has them: JFIF with an end marker in its data (as thumbnails have), a scan with stuffed
// bytes and a restart marker, more tables, another scan.
const std::string kJpeg = "\xff\xd8\xff\xe0\0\6\xff\xd9\1\2\xff\xda\0\3\1"s + "abc\xff\0de\xff\xd3gh"s +
                          "\xff\xc4\0\4xy\xff\xff\xda\0\3\1ij"s + "\xff\xd9"s;
const std::string kPng = "\x89PNG\r\n\x1a\n\0\0\0\3IHDRabc1234\0\0\0\4IDATIEND5678\0\0\0\0IEND9012"s;

bool cut(const std::string& bytes) {
  std::istringstream file(bytes);
  return is_cut_short(file);
}
int64_t interlaced(const std::string& bytes) {
  std::istringstream file(bytes);
  return interlaced_bytes(file);
}

TEST(Truncation, WholeFilesAreWhole) {
  EXPECT_FALSE(cut(kJpeg));
  EXPECT_FALSE(cut(kJpeg + "what cameras leave behind"));
  EXPECT_FALSE(cut(kPng));
  EXPECT_FALSE(cut("another format"));
  EXPECT_FALSE(cut(""));
}

TEST(Truncation, EveryCutIsSeen) {
  for (size_t length = 3; length < kJpeg.size(); ++length) {
    EXPECT_TRUE(cut(kJpeg.substr(0, length))) << length;
  }
  for (size_t length = 8; length < kPng.size(); ++length) {
    EXPECT_TRUE(cut(kPng.substr(0, length))) << length;
  }
}

TEST(Truncation, IsFoundBehindLongData) {
  const std::string scan(200000, 'x');
  const std::string jpeg = "\xff\xd8\xff\xda\0\3\1"s + scan + "\xff\xd9"s;
  EXPECT_FALSE(cut(jpeg));
  EXPECT_TRUE(cut(jpeg.substr(0, jpeg.size() - 1)));
}

TEST(Truncation, InterlacedFilesAreKnown) {
  EXPECT_EQ(interlaced(kJpeg), 0);
  const std::string jpeg = "\xff\xd8\xff\xe0\0\3\1\xff\xc2\0\x0b\x08\0\x10\1\0\3\1\x11\0\xff\xd9"s;
  EXPECT_EQ(interlaced(jpeg), 16 * 256 * 3 * 2);
  EXPECT_EQ(interlaced(jpeg.substr(0, 16)), 0) << "ends within its frame header";
  std::string png = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\5\0\0\0\7\x8\2\0\0\0crc_"s;
  EXPECT_EQ(interlaced(png), 0);
  png[28] = 1;
  EXPECT_EQ(interlaced(png), 5 * 7 * 8);
  EXPECT_EQ(interlaced(""), 0);
}

TEST(Truncation, OfARealPng) {
  PELAGE_REQUIRE_DATA();
  const std::string png = read_file(data_folder() / "mesh/spot_texture.png");
  EXPECT_FALSE(cut(png));
  EXPECT_TRUE(cut(png.substr(0, png.size() - 1)));
}

}  // namespace
}  // namespace pelage
