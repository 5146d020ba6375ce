// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "base/file.h"
#include "base/temporary_folder.h"
#include "image/exr.h"
#include "image/field_operations.h"
#include "image/map_field.h"
#include "image/texture_library.h"
#include "tests/support/data.h"

namespace pelage {
namespace {

class Textures : public testing::Test {
 protected:
  AssetPath write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder.path() / name, std::ios::binary) << bytes;
    return asset(name);
  }
  AssetPath asset(const std::string& name) const { return {folder.path() / name, {"scene.yaml", 7, 9}}; }

  /// 8-bit binary PPM (RGB) or PGM (grey), rows from the top.
  AssetPath write_pnm(const std::string& name, int width, int height, int channels,
                      const std::vector<int>& values) {
    std::string bytes =
        (channels == 3 ? "P6 " : "P5 ") + std::to_string(width) + " " + std::to_string(height) + " 255\n";
    for (int v : values) bytes += static_cast<char>(v);
    return write(name, bytes);
  }

  std::string message_of(const AssetPath& file) {
    try {
      library.load(file);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      EXPECT_EQ(error.problems()[0].position.line, 7);
      EXPECT_EQ(error.problems()[0].position.column, 9);
      const std::string text = error.problems()[0].message;
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
      EXPECT_EQ(text.find(file.path.string() + ": "), 0u) << text;
      return text.substr(std::min(text.size(), file.path.string().size() + 2));
    }
    ADD_FAILURE() << "no error";
    return {};
  }

  TemporaryFolder folder;
  MemoryLedger ledger;
  TextureLibrary library{ledger};
};

TEST_F(Textures, HaveTheirFirstRowAtTheTop) {
  // Top left red, top right green, bottom left blue, bottom right black.
  const AssetPath file = write_pnm("a.ppm", 2, 2, 3, {255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0});
  const auto texture = library.load(file);
  EXPECT_EQ(texture->color(0.25f, 0.75f), Rgb(1, 0, 0));
  EXPECT_EQ(texture->color(0.75f, 0.75f), Rgb(0, 1, 0));
  EXPECT_EQ(texture->color(0.25f, 0.25f), Rgb(0, 0, 1));
  EXPECT_EQ(texture->color(0.75f, 0.25f), Rgb(0, 0, 0));
  EXPECT_EQ(texture->color(0.5f, 0.5f), Rgb(0.25f));
  EXPECT_EQ(texture->channel(0.25f, 0.5f, 2), 0.5f);
}

TEST_F(Textures, RepeatInBothDirectionsIfAsked) {
  constexpr auto kRepeat = TextureWrap::kRepeat;
  const Texture texture(Image{3, 2, 1, {0, 1, 2, 3, 4, 5}});
  for (float u : {0.05f, 0.4f, 0.99f}) {
    for (float v : {0.02f, 0.6f}) {
      EXPECT_NEAR(texture.channel(u, v, 0, kRepeat), texture.channel(u + 2, v, 0, kRepeat), 1e-5f);
      EXPECT_NEAR(texture.channel(u, v, 0, kRepeat), texture.channel(u, v - 3, 0, kRepeat), 1e-5f);
    }
  }
  EXPECT_FLOAT_EQ(texture.channel(0, 0.75f, 0, kRepeat), 1)
      << "half of the first and half of the last column";
  EXPECT_EQ(texture.channel(-1e-9f, 1e-9f, 0, kRepeat), texture.channel(0, 0, 0, kRepeat));
}

TEST_F(Textures, EndAtTheirBorder) {
  const Texture texture(Image{3, 2, 1, {0, 1, 2, 3, 4, 5}});
  for (const float outside : {0.0f, -1e-7f, -0.3f, -4.0f}) {
    EXPECT_EQ(texture.channel(outside, 0.75f, 0), 0) << "the first column alone";
    EXPECT_EQ(texture.channel(1 - outside, 0.75f, 0), 2) << "the last column alone";
    EXPECT_EQ(texture.channel(0.5f, outside, 0), 4) << "the lower row alone";
    EXPECT_EQ(texture.channel(0.5f, 1 - outside, 0), 1) << "the upper row alone";
  }
  EXPECT_FLOAT_EQ(texture.channel(1.0f / 3, 0.5f, 0), 2) << "the middle of four texels";
  EXPECT_EQ(texture.color(0.5f, 0.75f), Rgb(1)) << "grey is spread";
  EXPECT_TRUE(std::isfinite(texture.channel(std::nanf(""), INFINITY, 0)));
}

TEST_F(Textures, DecodeIntegersFromSrgbUnlessToldOtherwise) {
  const AssetPath file = write_pnm("a.ppm", 1, 1, 3, {188, 188, 0});
  EXPECT_NEAR(library.load(file)->color(0, 0).x, 0.5029f, 1e-4f);
  EXPECT_NEAR(library.load(file, ColorSpace::kSrgb)->color(0, 0).x, 0.5029f, 1e-4f);
  EXPECT_NEAR(library.load(file, ColorSpace::kLinear)->color(0, 0).x, 188.0f / 255, 1e-6f);
  EXPECT_EQ(library.load(file), library.load(file, ColorSpace::kSrgb)) << "one copy";
}

TEST_F(Textures, LeaveFloatingPointAlone) {
  ExrImage image;
  image.width = image.height = 1;
  for (const char* name : {"B", "G", "R"}) image.channels.push_back({name, ChannelType::kFloat, {7.5f}, {}});
  write_exr(asset("a.exr").path, image);
  EXPECT_EQ(library.load(asset("a.exr"))->color(0, 0), Rgb(7.5f));
  EXPECT_EQ(library.load(asset("a.exr")), library.load(asset("a.exr"), ColorSpace::kLinear));
}

TEST_F(Textures, AreChargedOnceAndReleased) {
  {
    TextureLibrary other(ledger);
    const AssetPath file = write_pnm("a.pgm", 16, 8, 1, std::vector<int>(128, 7));
    other.load(file);
    other.load(file);
    other.load(file, ColorSpace::kSrgb);
    constexpr int kTexels = 16 * 8, kDecoder = 256 * 4;
    EXPECT_EQ(ledger.current(MemoryTag::kTextures), kTexels + kDecoder) << "bytes stay bytes";
    other.load(file, ColorSpace::kLinear);
    EXPECT_EQ(ledger.current(MemoryTag::kTextures), kTexels + 2 * kDecoder) << "texels are shared";
  }
  EXPECT_EQ(ledger.current(MemoryTag::kTextures), 0);
}

TEST_F(Textures, AreNeverBlackForWantOfAFile) {
  EXPECT_EQ(message_of(asset("none.png")), "there is no such file");
  EXPECT_EQ(message_of({folder.path(), {"scene.yaml", 7, 9}}), "is not a regular file");
  EXPECT_EQ(message_of(write("empty.png", "")), "is empty");
  EXPECT_EQ(
      message_of(write("lfs.hdr", "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 12\n")),
      "is a git-lfs pointer, not the file itself");
  EXPECT_NE(message_of(write("text.png", "no picture at all")), "");
  EXPECT_NE(message_of(write("short.ppm", "P6 4 4 255\nabc")), "");
  EXPECT_EQ(ledger.current(MemoryTag::kTextures), 0);
}

TEST_F(Textures, RefuseImagesWithNumbersThatAreNone) {
  ExrImage image;
  image.width = 2;
  image.height = 2;
  image.channels.push_back({"Y", ChannelType::kFloat, {1, 2, 3, std::nanf("")}, {}});
  write_exr(asset("nan.exr").path, image);
  EXPECT_EQ(message_of(asset("nan.exr")), "contains a non-finite value at pixel 1, 1");
}

TEST_F(Textures, ClaimedSizesCostNothing) {
  const std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 32000\n";
  EXPECT_NE(message_of(write("huge.hdr", hdr + std::string(64, '\2'))), "");
  EXPECT_NE(message_of(write("wide.ppm", "P6 2000000000 2000000000 255\nabc")), "");
}

TEST_F(Textures, LoadFromManyThreadsAtOnce) {
  const AssetPath a = write_pnm("a.pgm", 4, 4, 1, std::vector<int>(16, 7));
  const AssetPath b = write_pnm("b.pgm", 4, 4, 1, std::vector<int>(16, 9));
  std::vector<std::shared_ptr<const Texture>> loaded(8);
  std::vector<std::thread> threads;
  for (size_t i = 0; i < loaded.size(); ++i) {
    threads.emplace_back([&, i] { loaded[i] = library.load(i % 2 ? a : b); });
  }
  for (std::thread& thread : threads) thread.join();
  for (size_t i = 2; i < loaded.size(); ++i) EXPECT_EQ(loaded[i], loaded[i % 2]);
}

TEST_F(Textures, FeedFields) {
  // Two texels: linear data 51/255 and 204/255.
  const AssetPath file = write_pnm("a.pgm", 2, 1, 1, {51, 204});
  MapForm form;
  form.map = file;
  form.channel = MapChannel::kG;
  form.range = V2f(1, 2);
  const Field field = map_field(form);
  EXPECT_EQ(field.value_range(), std::pair(1.0f, 2.0f));
  const Field loaded = product_field({clamped_field(field, 0, 1.5f), Field(2.0f)}).with_textures(library);
  FieldPoint point;
  point.u = 0.25f;
  EXPECT_NEAR(loaded.value(point), 2.4f, 1e-5f);
  point.u = 0.75f;
  EXPECT_NEAR(loaded.value(point), 3, 1e-5f);
  EXPECT_NEAR(loaded.value_range().first, 2.4f, 1e-5f);
  EXPECT_NEAR(loaded.value_range().second, 3, 1e-5f);
  EXPECT_TRUE(loaded.dependence().surface);

  form.channel.reset();
  const Field color = map_field(form).with_textures(library);
  EXPECT_NEAR(color.color(point).y, 1 + std::pow((0.8f + 0.055f) / 1.055f, 2.4f), 1e-5f)
      << "a colour is sRGB";

  form.channel = MapChannel::kA;
  try {
    map_field(form).with_textures(library);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              "scene.yaml:7:9: " + file.path.string() + ": has no channel 'a', only 1");
  }
}

/// The child is a new process: here another test may have loaded the module already.
TEST(TexturesDeathTest, FirstLoadIsChargedForTheModule) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto module_bytes = [] {
    const TemporaryFolder place;
    std::ofstream(place.path() / "a.pgm") << "P2 1 1 255 7";
    MemoryLedger ledger;
    TextureLibrary(ledger).load({place.path() / "a.pgm", {}});
    return ledger.peak(MemoryTag::kLibraries);
  };
  EXPECT_EXIT(std::exit(module_bytes() > 10 << 20 ? 0 : 1), testing::ExitedWithCode(0), "");
}

/// In a new process too.
TEST(TexturesDeathTest, RadianceFilesLoadNoModule) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto costs_nothing_but_texels = [] {
    const TemporaryFolder place;
    std::ofstream(place.path() / "a.hdr") << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n@@@\x81"
                                             "abc\x80";
    MemoryLedger ledger;
    TextureLibrary library(ledger);
    const auto texture = library.load({place.path() / "a.hdr", {}});
    constexpr int kTexels = 2 * 3 * 4, kRow = 2 * 4;
    return texture->channel(0.25f, 0.5f, 0) == 0.5f && ledger.peak(MemoryTag::kLibraries) == 0 &&
           ledger.current(MemoryTag::kTextures) == kTexels &&
           ledger.peak(MemoryTag::kTextures) == 2 * kTexels + kRow;
  };
  EXPECT_EXIT(std::exit(costs_nothing_but_texels() ? 0 : 1), testing::ExitedWithCode(0), "");
}

TEST_F(Textures, ReadRealEnvironments) {
  PELAGE_REQUIRE_DATA();
  for (const char* name : {"studio_small_03_1k.hdr", "venice_sunset_1k.hdr"}) {
    const auto texture = library.load({data_folder() / "env" / name, {}});
    EXPECT_EQ(texture->width(), 1024);
    EXPECT_EQ(texture->height(), 512);
    EXPECT_EQ(texture->channels(), 3);
    EXPECT_GT(texture->range(0).second, 10.0f) << name << " is not of high dynamic range";
  }
  const int64_t image_bytes = 1024 * 512 * 3 * 4;
  EXPECT_EQ(ledger.current(MemoryTag::kTextures), 2 * image_bytes);
}

TEST_F(Textures, RefuseATruncatedEnvironment) {
  PELAGE_REQUIRE_DATA();
  const std::string whole = read_file(data_folder() / "env/studio_small_03_1k.hdr");
  EXPECT_EQ(message_of(write("cut.hdr", whole.substr(0, whole.size() / 2))), "is truncated");
  const std::string png = read_file(data_folder() / "mesh/spot_texture.png");
  EXPECT_EQ(message_of(write("cut.png", png.substr(0, png.size() / 2))), "is truncated");
}

}  // namespace
}  // namespace pelage
