// SPDX-License-Identifier: Apache-2.0
#include "image/truncation.h"

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

TEST(Truncation, WholeFilesAreWhole) {
  EXPECT_FALSE(is_cut_short(kJpeg));
  EXPECT_FALSE(is_cut_short(kJpeg + "what cameras leave behind"));
  EXPECT_FALSE(is_cut_short(kPng));
  EXPECT_FALSE(is_cut_short("another format"));
  EXPECT_FALSE(is_cut_short(""));
}

TEST(Truncation, EveryCutIsSeen) {
  for (size_t length = 3; length < kJpeg.size(); ++length) {
    EXPECT_TRUE(is_cut_short(kJpeg.substr(0, length))) << length;
  }
  for (size_t length = 8; length < kPng.size(); ++length) {
    EXPECT_TRUE(is_cut_short(kPng.substr(0, length))) << length;
  }
}

TEST(Truncation, OfARealPng) {
  PELAGE_REQUIRE_DATA();
  const std::string png = read_file(data_folder() / "mesh/spot_texture.png");
  EXPECT_FALSE(is_cut_short(png));
  EXPECT_TRUE(is_cut_short(png.substr(0, png.size() - 1)));
}

}  // namespace
}  // namespace pelage
