// SPDX-License-Identifier: Apache-2.0
// OpenEXR's sample of ten parts and two views, which nobody here wrote.
#include <map>

#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "post/blur_file.h"
#include "post/stereo_file.h"
#include "tests/post/exr_pictures.h"
#include "tests/support/data.h"

namespace pelage {
namespace {

std::filesystem::path beachball() { return data_folder() / "exr/Beachball_multipart.0001.exr"; }

/// A channel of a part, by pixel of the display window; zero beyond its data window.
class Channel {
 public:
  Channel(const std::filesystem::path& path, const std::string& part, const std::string& channel) {
    const ExrReader reader(path);
    for (size_t p = 0; p < reader.parts().size(); ++p) {
      const ExrPart& info = reader.parts()[p];
      for (size_t c = 0; c < info.channels.size(); ++c) {
        if (info.name != part || info.channels[c].name != channel) continue;
        box_ = info.data;
        pixels_ = read_part(path, p)[c];
        return;
      }
    }
    ADD_FAILURE() << "no " << part << " " << channel;
  }
  float at(int x, int y) const {
    if (x < box_.x0 || y < box_.y0 || x >= box_.x1 || y >= box_.y1) return 0;
    return pixels_[static_cast<size_t>(y - box_.y0) * static_cast<size_t>(box_.width()) +
                   static_cast<size_t>(x - box_.x0)];
  }
  const PixelBox& box() const { return box_; }

 private:
  PixelBox box_;
  std::vector<float> pixels_;
};

/// Peak signal to noise ratio of the ball in two files' right views, in dB; white is 1. `inside`: only where
/// the ball covers whole pixels.
double psnr(const std::filesystem::path& made, bool inside) {
  double error = 0;
  size_t count = 0;
  const Channel alpha(beachball(), "rgba_right", "A"), made_alpha(made, "rgba_right", "A"),
      invented(made, "rgba_right", "invented.mask");
  for (const char* name : {"R", "G", "B", "A"}) {
    const Channel truth(beachball(), "rgba_right", name), ours(made, "rgba_right", name);
    for (int y = 240; y < 1125; ++y) {
      for (int x = 640; x < 1570; ++x) {
        const bool ball = inside ? alpha.at(x, y) > 0.999f : alpha.at(x, y) > 0 || made_alpha.at(x, y) > 0;
        if (!ball || invented.at(x, y) > 0) continue;
        const double e = static_cast<double>(ours.at(x, y)) - static_cast<double>(truth.at(x, y));
        error += e * e;
        ++count;
      }
    }
  }
  EXPECT_GT(count, 1'000'000u);
  return -10 * std::log10(error / static_cast<double>(count));
}

TEST(Beachball, OneEyeIsMadeOfTheOther) {
  PELAGE_REQUIRE_DATA();
  const TemporaryFolder folder;
  NoProgress progress;
  MemoryLedger ledger;
  StereoFileParams params;
  params.parallax = "disparityR";
  params.file.scale = 4;
  stereo_file(beachball(), folder.path() / "a.exr", params, {Workers(), ledger, progress});
  EXPECT_GT(psnr(folder.path() / "a.exr", false), 50);
  EXPECT_GT(psnr(folder.path() / "a.exr", true), 55);
  // By depth: its parallax is -333.3 / Z, parallel cameras.
  params.parallax.clear();
  params.focal_pixels = 333.312f;
  params.eye_separation = 1;
  stereo_file(beachball(), folder.path() / "b.exr", params, {Workers(), ledger, progress});
  EXPECT_GT(psnr(folder.path() / "b.exr", true), 50);
  EXPECT_GT(psnr(folder.path() / "b.exr", false), 40);
}

/// Where the ball's alpha is centred.
V2f centre(const std::filesystem::path& path) {
  const Channel alpha(path, "rgba_left", "A");
  double sum = 0, sx = 0, sy = 0;
  for (int y = alpha.box().y0; y < alpha.box().y1; ++y) {
    for (int x = alpha.box().x0; x < alpha.box().x1; ++x) {
      const auto a = static_cast<double>(alpha.at(x, y));
      sum += a;
      sx += a * x;
      sy += a * y;
    }
  }
  return {static_cast<float>(sx / sum), static_cast<float>(sy / sum)};
}

TEST(Beachball, ItsVectorsPointRightAndUp) {
  PELAGE_REQUIRE_DATA();
  // By the published data windows, frame 2 has the ball 105 pixels to the right and 128 below: u counts to
  // the right, but v upwards, and both are 0.4 or less of the way to the next frame.
  const TemporaryFolder folder;
  NoProgress progress;
  MemoryLedger ledger;
  BlurFileParams params;
  params.file.scale = 1;
  params.file.vectors.is_y_up = true;
  params.shutter = {0, 1, 1};
  const V2f before = centre(beachball());
  const PostReport report =
      blur_file(beachball(), folder.path() / "moved.exr", params, {Workers(), ledger, progress});
  EXPECT_NEAR(report.longest, 60.2f, 0.1f);
  const V2f moved = centre(folder.path() / "moved.exr") - before;
  // The outline moves by (39.6, 38.1), the middle of the ball, which is nearer, by more.
  EXPECT_NEAR(moved.x, 39.6, 0.3);
  EXPECT_NEAR(moved.y, 38.1, 0.3);
}

TEST(Beachball, KeepsItsTenParts) {
  PELAGE_REQUIRE_DATA();
  const TemporaryFolder folder;
  NoProgress progress;
  MemoryLedger ledger;
  BlurFileParams params;
  params.file.scale = 1;
  params.shutter.steps = 2;
  const std::filesystem::path out = folder.path() / "out.exr";
  blur_file(beachball(), out, params, {Workers(), ledger, progress});
  const ExrReader before(beachball()), after(out);
  ASSERT_EQ(after.parts().size(), 10u);
  for (size_t p = 0; p < 10; ++p) {
    EXPECT_EQ(after.parts()[p].name, before.parts()[p].name);
    EXPECT_EQ(after.parts()[p].view, before.parts()[p].view);
    EXPECT_EQ(after.parts()[p].channels, before.parts()[p].channels);
    EXPECT_EQ(after.parts()[p].display, before.parts()[p].display);
    const PixelBox& a = after.parts()[p].data;
    const PixelBox& b = before.parts()[p].data;
    EXPECT_TRUE(a.x0 <= b.x0 && a.y0 <= b.y0 && a.x1 >= b.x1 && a.y1 >= b.y1);
  }
  // Disparity belongs to no view and does not move.
  EXPECT_EQ(after.parts()[7].data, before.parts()[7].data);
  EXPECT_EQ(read_part(out, 7), read_part(beachball(), 7));
}

}  // namespace
}  // namespace pelage
