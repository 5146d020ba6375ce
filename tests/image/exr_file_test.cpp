// SPDX-License-Identifier: Apache-2.0
#include "image/exr_file.h"

#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/temporary_folder.h"
#include "tests/post/exr_pictures.h"
#include "tests/support/data.h"

namespace pelage {
namespace {

TEST(ExrFile, PartsWithWindowsOfTheirOwnComeBack) {
  const TemporaryFolder folder;
  const std::filesystem::path like = folder.path() / "like.exr", path = folder.path() / "parts.exr";
  ExrImage image = still_image(4, 4);
  image.attributes["comments"] = std::string("carried");
  write_exr(like, image);
  const PixelBox display{0, 0, 50, 40}, a{-3, 5, 17, 25}, b{10, 0, 14, 40};
  std::vector<float> half_plane(20 * 20), float_plane(20 * 20), other(4 * 40);
  for (size_t i = 0; i < half_plane.size(); ++i) {
    half_plane[i] = static_cast<float>(i) / 8;
    float_plane[i] = signed_float(hash64(i, 1));
  }
  half_plane[3] = 1e9f;  // more than a half holds
  write_parts(
      path, like, display,
      {{"one", a, {{"R", ChannelType::kHalf}, {"Z", ChannelType::kFloat}}, {half_plane, float_plane}, "left"},
       {"two", b, {{"mask.a", ChannelType::kFloat}}, {other}, ""}});
  const ExrReader reader(path, 2);
  ASSERT_EQ(reader.parts().size(), 2u);
  EXPECT_EQ(reader.parts()[0].name, "one");
  EXPECT_EQ(reader.parts()[0].view, "left");
  EXPECT_EQ(reader.parts()[0].data, a);
  EXPECT_EQ(reader.parts()[1].data, b);
  EXPECT_EQ(reader.parts()[1].display, display);
  EXPECT_EQ(std::get<std::string>(reader.parts()[0].attributes.at("comments")), "carried");
  EXPECT_GT(reader.buffer_bytes(), 0);
  half_plane[3] = 65504;
  const auto planes = read_part(path, 0);
  EXPECT_EQ(planes[0], half_plane);
  EXPECT_EQ(planes[1], float_plane);
}

TEST(ExrFile, RowsMayBeReadInAnyOrder) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.exr";
  const ExrImage image = still_image(13, 70);
  write_exr(path, image);
  ExrReader reader(path);
  for (int y : {40, 3, 69, 0}) {
    std::vector<float> row(13);
    const ExrRows rows[] = {{4, row.data(), 13}};
    EXPECT_EQ(reader.parts()[0].channels[4].name, "Z");
    const ExrRows red[] = {{3, row.data(), 13}};
    reader.read(0, y, y + 1, rows);
    reader.read(0, y, y + 1, red);
    const auto from = image.find("R")->pixels.begin() + 13 * y;
    EXPECT_EQ(row, std::vector<float>(from, from + 13));
  }
}

TEST(ExrFile, AnUnfinishedFileIsNoFile) {
  const TemporaryFolder folder;
  write_exr(folder.path() / "like.exr", still_image(4, 4));
  {
    const ExrReader reader(folder.path() / "like.exr");
    ExrWriter writer(folder.path() / "new.exr", reader, {{0, reader.parts()[0]}});
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "new.exr"));
}

TEST(ExrFile, ReadsOthersParts) {
  PELAGE_REQUIRE_DATA();
  const ExrReader beach(data_folder() / "exr/Beachball_multipart.0001.exr");
  ASSERT_EQ(beach.parts().size(), 10u);
  EXPECT_EQ(beach.parts()[3].name, "whitebarmask_left");
  EXPECT_EQ(beach.parts()[3].data, (PixelBox{1106, 245, 1491, 1014}));
  EXPECT_EQ(beach.parts()[7].view, "");
  EXPECT_EQ(beach.parts()[7].display, (PixelBox{0, 0, 2048, 1556}));
}

}  // namespace
}  // namespace pelage
