// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/lod_pictures.h"

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "base/file.h"
#include "base/process.h"
#include "base/temporary_folder.h"
#include "image/exr.h"

namespace pelage {
namespace {

/// Shares from none to all in one row; the second row half covers its pixels.
ExrImage shares() {
  constexpr int kWidth = 101;
  ExrImage image;
  image.width = kWidth;
  image.height = 2;
  ExrChannel lod, alpha;
  lod.name = "lod";
  alpha.name = "A";
  lod.type = alpha.type = ChannelType::kFloat;
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      lod.pixels.push_back(static_cast<float>(x) / (kWidth - 1));
      alpha.pixels.push_back(y == 0 ? 1.0f : 0.5f);
    }
  }
  image.channels = {lod, alpha};
  return image;
}

/// The report and the script draw the same scale, each by its own means.
TEST(LodPictures, DetailHasTheColoursOfTheScript) {
  const TemporaryFolder folder;
  const auto exr = folder.path() / "a.exr", ppm = folder.path() / "a.ppm";
  write_exr(exr, shares());
  const ProcessResult made =
      run_process({{PELAGE_SOURCE_DIR "/tools/exr_to_png", exr.string(), ppm.string(), "lod"}});
  ASSERT_TRUE(made.end.succeeded()) << made.errors;
  const std::string file = read_file(ppm);
  const auto picture = detail_picture(exr);
  ASSERT_TRUE(picture);
  ASSERT_EQ(picture->pixels.size(), 3u * 101 * 2);
  ASSERT_GT(file.size(), picture->pixels.size());
  const std::string drawn = file.substr(file.size() - picture->pixels.size());  // behind the head
  ASSERT_EQ(file.substr(0, 2), "P6");
  int max = 0;
  for (size_t i = 0; i < drawn.size(); ++i) {
    const int difference = std::abs(static_cast<unsigned char>(drawn[i]) - picture->pixels[i]);
    EXPECT_LE(difference, 2) << "share " << i / 3 % 101 << " %, channel " << i % 3;
    max = std::max(max, difference);
  }
  EXPECT_EQ(picture->pixels[2], 255) << "every strand: blue";
  EXPECT_EQ(picture->pixels[3 * 100], 255) << "none: red";
}

}  // namespace
}  // namespace pelage
