// SPDX-License-Identifier: Apache-2.0
#include "image/host_image.h"

#include <cstring>
#include <fstream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/temporary_folder.h"
#include "image/texture_library.h"

namespace pelage::host_image_test {
namespace {

std::vector<std::byte> bytes_of(const auto& values) {
  const auto bytes = std::as_bytes(std::span(values));
  return {bytes.begin(), bytes.end()};
}

AssetPath asset_of(const std::shared_ptr<const HostImage>& image) {
  return {image->name(), {"maps.density", 0, 0}, image};
}

TEST(HostImages, AreTheTexturesOfTheirFiles) {
  const std::vector<uint8_t> texels{255, 0, 0, 0, 255, 0, 0, 0, 255, 10, 20, 30};
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "a.ppm", std::ios::binary) << "P6 2 2 255\n"
                                                           << std::string(texels.begin(), texels.end());
  MemoryLedger ledger;
  TextureLibrary library(ledger);
  const auto image = share_image({2, 2, 3, TexelKind::kU8}, bytes_of(texels));
  for (const ColorSpace space : {ColorSpace::kAuto, ColorSpace::kLinear, ColorSpace::kSrgb}) {
    const auto a = library.load({folder.path() / "a.ppm", {}}, space),
               b = library.load(asset_of(image), space);
    EXPECT_EQ(b, library.load(asset_of(image), space));
    for (const float u : {0.1f, 0.5f, 0.8f}) EXPECT_EQ(a->color(u, 0.4f), b->color(u, 0.4f));
  }
  const int64_t held = ledger.budgeted();
  library.forget_changed();
  EXPECT_EQ(ledger.budgeted(), held);  // what a host made does not change
  library.forget_unused();
  EXPECT_LT(ledger.budgeted(), held);
}

TEST(HostImages, BecomeTilesWhenTheyDoNotFit) {
  constexpr int kSide = 1024;
  std::vector<float> texels(size_t(kSide) * kSide);
  for (size_t i = 0; i < texels.size(); ++i) texels[i] = static_cast<float>(i % 1000);
  const auto image = share_image({kSide, kSide, 1, TexelKind::kFloat}, bytes_of(texels));
  MemoryLedger free, tight;
  tight.set_limit(int64_t(12) << 20);  // a quarter is less than the 4 MiB of the image
  TextureLibrary whole(free), tiles(tight);
  const auto a = whole.load(asset_of(image)), b = tiles.load(asset_of(image));
  EXPECT_LE(tight.budgeted(), int64_t(11) << 20);  // the smallest cache of tiles, 10 MiB
  for (const float u : {0.0f, 0.3f, 0.77f}) EXPECT_EQ(a->channel(u, 0.6f, 0), b->channel(u, 0.6f, 0));
}

TEST(HostImages, HaveErrors) {
  EXPECT_THROW(share_image({2, 2, 5, TexelKind::kU8}, std::vector<std::byte>(20)), Error);
  EXPECT_THROW(share_image({0, 2, 1, TexelKind::kU8}, {}), Error);
  EXPECT_THROW(share_image({2, 2, 1, TexelKind::kU8}, std::vector<std::byte>(5)), Error);
  MemoryLedger ledger;
  TextureLibrary library(ledger);
  const std::vector<float> bad{0, 1, 2, std::nanf("")};
  const auto image = share_image({2, 2, 1, TexelKind::kFloat}, bytes_of(bad));
  try {
    library.load(asset_of(image));
    FAIL() << "loaded";
  } catch (const Error& error) {
    EXPECT_EQ(error.problems()[0].position.file, "maps.density");
    EXPECT_NE(error.problems()[0].message.find("non-finite value at pixel 1, 1"), std::string::npos);
  }
}

}  // namespace
}  // namespace pelage::host_image_test
