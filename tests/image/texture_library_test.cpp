// SPDX-License-Identifier: Apache-2.0
// Textures that are kept in tiles against all of their texels in memory.
#include "image/texture_library.h"

#include <cmath>
#include <fstream>
#include <functional>
#include <memory>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/memory_sample.h"
#include "base/temporary_folder.h"
#include "image/exr.h"
#include "image/image_reader.h"
#include "tests/support/effort.h"

namespace pelage {
namespace {

constexpr int64_t kSmallLimit = int64_t(16) << 20;

/// Looks at every call whether to stop.
class WatchedProgress : public Progress {
 public:
  explicit WatchedProgress(int calls_until_stop = 1 << 30) : left_(calls_until_stop) {}
  void begin(std::string_view stage, double total) override {
    stages.emplace_back(stage);
    expected = total;
  }
  void advance(double amount) override {
    done += amount;
    highest = std::max(highest, resident_memory().anonymous);
  }
  void end() override { ++ended; }
  bool cancelled() const override { return --left_ < 0; }

  std::vector<std::string> stages;
  double expected = 0, done = 0;
  int ended = 0;
  int64_t highest = 0;

 private:
  mutable int left_;
};

struct Case {
  const char* name;
  int width, height, channels;
  std::function<void(const std::filesystem::path&, const Case&)> write;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

/// Noise of millions of texels: cheaper than hash64() with a sanitizer.
uint32_t number(int x, int y, int c) {
  uint32_t mixed = static_cast<uint32_t>(x) * 0x9e3779b1u ^ static_cast<uint32_t>(y) * 0x85ebca6bu ^
                   static_cast<uint32_t>(c) * 0xc2b2ae35u;
  mixed = (mixed ^ mixed >> 15) * 0x2c1b3c6du;
  return mixed ^ mixed >> 13;
}

void write_pnm(const std::filesystem::path& file, const Case& c, int max) {
  std::string bytes = (c.channels == 3 ? "P6 " : "P5 ") + std::to_string(c.width) + " " +
                      std::to_string(c.height) + " " + std::to_string(max) + "\n";
  size_t at = bytes.size();
  bytes.resize(at + static_cast<size_t>(c.width * c.channels * c.height) * (max > 255 ? 2 : 1));
  char* const texels = bytes.data();
  for (int y = 0; y < c.height; ++y) {
    for (int i = 0; i < c.width * c.channels; ++i) {
      const uint32_t v = number(i, y, 0);
      if (max > 255) texels[at++] = static_cast<char>(v >> 8);
      texels[at++] = static_cast<char>(v);
    }
  }
  std::ofstream(file, std::ios::binary) << bytes;
}
void write_bytes(const std::filesystem::path& file, const Case& c) { write_pnm(file, c, 255); }
void write_words(const std::filesystem::path& file, const Case& c) { write_pnm(file, c, 65535); }

ExrImage exr_image(const Case& c, ChannelType type) {
  ExrImage image;
  image.width = c.width;
  image.height = c.height;
  const std::vector<std::string> names = c.channels == 1   ? std::vector<std::string>{"Y"}
                                         : c.channels == 2 ? std::vector<std::string>{"A", "Y"}
                                                           : std::vector<std::string>{"A", "B", "G", "R"};
  int index = 0;
  for (const std::string& name : names) {
    std::vector<float> pixels;
    for (int y = 0; y < c.height; ++y) {
      for (int x = 0; x < c.width; ++x) {
        pixels.push_back(static_cast<float>(number(x, y, index) % 60000) / 3000 - 1);
      }
    }
    image.channels.push_back({name, type, std::move(pixels), {}});
    ++index;
  }
  return image;
}
void write_halves(const std::filesystem::path& file, const Case& c) {
  write_exr(file, exr_image(c, ChannelType::kHalf));
}
void write_floats(const std::filesystem::path& file, const Case& c) {
  write_exr(file, exr_image(c, ChannelType::kFloat));
}
/// Without run lengths.
void write_rgbe(const std::filesystem::path& file, const Case& c) {
  std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(c.height) + " +X " +
                      std::to_string(c.width) + "\n";
  for (int y = 0; y < c.height; ++y) {
    for (int x = 0; x < c.width; ++x) {
      const uint32_t v = number(x, y, 0);
      // No first byte of 1 or 2, which would begin a run.
      for (uint32_t byte : {v % 250 + 3, v >> 8, v >> 16, 120 + v % 16}) bytes += static_cast<char>(byte);
    }
  }
  std::ofstream(file, std::ios::binary) << bytes;
}

class TiledTextures : public testing::TestWithParam<Case> {
 protected:
  static void SetUpTestSuite() { written_ = std::make_unique<TemporaryFolder>(); }
  static void TearDownTestSuite() { written_.reset(); }
  /// Writes the file of the case once for all tests, because this takes longer than most of them.
  void SetUp() override {
    const std::filesystem::path once = written_->path() / GetParam().name;
    if (!std::filesystem::exists(once)) GetParam().write(once, GetParam());
    file = {folder.path() / GetParam().name, {"scene.yaml", 7, 9}};
    std::filesystem::copy_file(once, file.path);
  }
  TemporaryFolder folder;
  AssetPath file;

 private:
  static inline std::unique_ptr<TemporaryFolder> written_;
};

float coordinate(uint64_t i, uint64_t use) {
  const float u = unit_float(hash64(i, use, 0, 3));
  if (i % 7 == 0) return std::floor(u * 8 - 4) / 2;  // seams
  return i % 5 == 0 ? u * 20 - 10 : u;
}

TEST_P(TiledTextures, AreLookedUpLikeThoseInMemory) {
  MemoryLedger free, limited;
  limited.set_limit(kSmallLimit);
  TextureLibrary truth(free), tiled(limited);
  const uint64_t lookups = repetitions(4000);  // of a thread; most decode a tile
  for (ColorSpace space : {ColorSpace::kAuto, ColorSpace::kLinear, ColorSpace::kSrgb}) {
    const auto expected = truth.load(file, space), found = tiled.load(file, space);
    const int channels = expected->channels();
    ASSERT_EQ(channels, GetParam().channels);
    for (int c = 0; c < channels; ++c) EXPECT_EQ(found->range(c), expected->range(c));
    std::vector<std::thread> threads;
    for (uint64_t t = 0; t < 4; ++t) {
      threads.emplace_back([&, t] {
        for (uint64_t i = t * lookups; i < (t + 1) * lookups; ++i) {
          const float u = coordinate(i, 1), v = coordinate(i, 2);
          const int c = static_cast<int>(i) % channels;
          ASSERT_EQ(found->channel(u, v, c), expected->channel(u, v, c)) << u << " " << v << " " << c;
          ASSERT_EQ(found->color(u, v), expected->color(u, v)) << u << " " << v;
          const auto x = static_cast<int>(hash64(i, 4, 0, 0) % static_cast<uint64_t>(expected->width()));
          const auto y = static_cast<int>(hash64(i, 5, 0, 0) % static_cast<uint64_t>(expected->height()));
          ASSERT_EQ(found->texel(x, y), expected->texel(x, y)) << x << " " << y;
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    // A rectangle over many tiles.
    const int width = std::min(200, expected->width() - 30), height = std::min(150, expected->height() - 20);
    std::vector<Rgb> a(static_cast<size_t>(width * height)), b(a.size());
    expected->colors(30, 20, width, height, a.data());
    found->colors(30, 20, width, height, b.data());
    EXPECT_EQ(a, b);
  }
  EXPECT_GT(free.peak(MemoryTag::kTextures), kSmallLimit / 4) << "the image is too small to need tiles";
  EXPECT_LE(limited.peak(MemoryTag::kTextures), kSmallLimit);
}

TEST_P(TiledTextures, TakeNoMoreMemoryThanTheySay) {
  MemoryLedger ledger;
  ledger.set_limit(kSmallLimit);
  WatchedProgress progress;
  TextureLibrary library(ledger, &progress);
  std::ofstream(folder.path() / "a.pgm") << "P2 1 1 255 7";
  library.load({folder.path() / "a.pgm", {}});  // loads the module
  const int64_t before = resident_memory().anonymous;
  progress.highest = before;
  const auto texture = library.load(file);
  for (uint64_t i = 0; i < 4000; ++i) texture->color(coordinate(i, 1), coordinate(i, 2));
  const int64_t highest = std::max(progress.highest, resident_memory().anonymous);
  if (!kSanitized) {
    EXPECT_LE(highest - before, kSmallLimit);
  }
  EXPECT_LE(ledger.peak(MemoryTag::kTextures), kSmallLimit);
}

TEST_P(TiledTextures, StopWhenAsked) {
  for (int64_t limit : {int64_t(0), kSmallLimit}) {
    MemoryLedger ledger;
    ledger.set_limit(static_cast<uint64_t>(limit));
    WatchedProgress progress(2);
    TextureLibrary library(ledger, &progress);
    try {
      library.load(file);
      ADD_FAILURE() << "went on";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kStopped);
    }
    EXPECT_EQ(progress.stages.size(), static_cast<size_t>(progress.ended));
    EXPECT_LE(ledger.current(MemoryTag::kTextures), limit ? TileCache::kSmallest : 0);
  }
}

TEST_P(TiledTextures, SayTheSameOfDamage) {
  std::filesystem::resize_file(file.path, std::filesystem::file_size(file.path) * 3 / 4);
  std::vector<std::string> messages;
  for (int64_t limit : {int64_t(0), kSmallLimit}) {
    MemoryLedger ledger;
    ledger.set_limit(static_cast<uint64_t>(limit));
    TextureLibrary library(ledger);
    try {
      library.load(file);
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      messages.emplace_back(error.what());
    }
  }
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages[0], messages[1]);
  EXPECT_EQ(messages[0].find("scene.yaml:7:9: " + file.path.string() + ": "), 0u) << messages[0];
}

// Sizes that are no multiples of a tile, and larger than the smallest cache of tiles.
INSTANTIATE_TEST_SUITE_P(Formats, TiledTextures,
                         testing::Values(Case{"bytes.ppm", 2100, 2011, 3, write_bytes},
                                         Case{"grey.pgm", 4100, 3001, 1, write_bytes},
                                         Case{"words.ppm", 1500, 1250, 3, write_words},
                                         Case{"half.exr", 1290, 1130, 4, write_halves},
                                         Case{"grey_alpha.exr", 1290, 1130, 2, write_floats},
                                         Case{"float.exr", 1010, 900, 4, write_floats},
                                         Case{"rgbe.hdr", 1100, 870, 3, write_rgbe}),
                         [](const auto& test) {
                           std::string name = test.param.name;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

class TextureBudget : public testing::Test {
 protected:
  AssetPath write(const char* name, int width, int height) {
    const Case c{name, width, height, 3, write_bytes};
    write_bytes(folder.path() / name, c);
    return {folder.path() / name, {"scene.yaml", 7, 9}};
  }
  TemporaryFolder folder;
};

TEST_F(TextureBudget, ForgetsWhatIsOldAndOnlyThat) {
  const AssetPath a = write("a.ppm", 20, 15), b = write("b.ppm", 30, 15);
  MemoryLedger ledger;
  TextureLibrary library(ledger);
  auto first = library.load(a), other = library.load(b);
  library.forget_changed();
  EXPECT_EQ(library.load(a), first);
  write("a.ppm", 10, 15);
  EXPECT_EQ(library.load(a), first) << "until it is told";
  library.forget_changed();
  const auto second = library.load(a);
  EXPECT_NE(second, first);
  EXPECT_EQ(library.load(b), other);

  const int64_t both = ledger.current(MemoryTag::kTextures);
  library.forget_unused();
  EXPECT_EQ(ledger.current(MemoryTag::kTextures), both);
  other = nullptr;
  library.forget_unused();
  EXPECT_LT(ledger.current(MemoryTag::kTextures), both);
  EXPECT_EQ(library.load(a), second);
}

TEST_F(TextureBudget, RefusesByNameWhatDoesNotFit) {
  const AssetPath file = write("a.ppm", 2000, 1500);
  MemoryLedger ledger;
  ledger.set_limit(4 << 20);
  TextureLibrary library(ledger);
  try {
    library.load(file);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
    const std::string text = error.what();
    EXPECT_EQ(text.find("scene.yaml:7:9: " + file.path.string() + ": "), 0u) << text;
    EXPECT_NE(text.find("render.memory is 4.0 MiB"), std::string::npos) << text;
  }
  EXPECT_EQ(ledger.current(MemoryTag::kTextures), 0);
}

TEST_F(TextureBudget, KeepsSmallImagesInMemoryUpToTheirShare) {
  const AssetPath small = write("small.ppm", 700, 700), large = write("large.ppm", 2000, 1000);
  MemoryLedger ledger;
  ledger.set_limit(kSmallLimit);
  TextureLibrary library(ledger);
  library.load(small);
  EXPECT_LT(ledger.current(MemoryTag::kTextures), 700 * 700 * 3 + 4096) << "needs no cache of tiles";
  library.load(large);
  EXPECT_GE(ledger.current(MemoryTag::kTextures), 700 * 700 * 3 + TileCache::kSmallest);
  EXPECT_LT(ledger.current(MemoryTag::kTextures), 700 * 700 * 3 + TileCache::kSmallest + 4096);
}

TEST_F(TextureBudget, ShowsTheReadingOfLargeImages) {
  const AssetPath small = write("small.ppm", 70, 70), large = write("large.ppm", 2500, 2500);
  MemoryLedger ledger;
  WatchedProgress progress;
  TextureLibrary library(ledger, &progress);
  library.load(small);
  EXPECT_TRUE(progress.stages.empty());
  library.load(large);
  EXPECT_EQ(progress.stages, std::vector<std::string>{"read large.ppm"});
  EXPECT_EQ(progress.done, progress.expected);
  EXPECT_EQ(progress.ended, 1);
}

TEST_F(TextureBudget, TilesThatAreLostAreAnError) {
  const TexelLayout layout{200, 100, 1, TexelKind::kU8};
  auto tiles = std::make_unique<TileFile>(layout);
  const std::vector<std::byte> rows(layout.bytes(), std::byte{9});
  tiles->add_rows(rows.data(), 30);
  tiles->add_rows(rows.data(), 70);
  const int descriptor = tiles->descriptor();
  const ImageReader reader;
  const auto cache = std::make_shared<TileCache>(reader, TileCache::kSmallest);
  const std::shared_ptr<const TexelStore> store = cache->store("a.png", layout, {{0, 1}}, std::move(tiles));
  const Texture texture(store, false);
  EXPECT_FLOAT_EQ(texture.channel(0.1f, 0.9f, 0), 9.0f / 255);
  ASSERT_EQ(::ftruncate(descriptor, 64 * 64), 0);
  EXPECT_FLOAT_EQ(texture.channel(0.1f, 0.9f, 0), 9.0f / 255) << "still known";
  for (int i = 0; i < 3; ++i) {
    try {
      texture.channel(0.9f, 0.1f, 0);
      FAIL() << "invented";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kFailed);
      EXPECT_EQ(std::string(error.what()).find("a.png: "), 0u) << error.what();
    }
  }
}

// The truth in plain code: what the texel decoder says of every stored value.
TEST(TexelDecoder, FollowsTheDefinitionOfSrgb) {
  for (TexelKind kind : {TexelKind::kU8, TexelKind::kU16}) {
    const uint32_t max = kind == TexelKind::kU8 ? 255 : 65535;
    const TexelDecoder decode({1, 1, 2, kind}, true);
    for (uint32_t i = 0; i <= max; ++i) {
      std::array<std::byte, 4> texel{};
      for (size_t c = 0; c < 2; ++c) std::memcpy(&texel[c * value_bytes(kind)], &i, value_bytes(kind));
      const double v = static_cast<double>(i) / max;
      const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
      ASSERT_NEAR(decode(texel.data(), 0), linear, 1e-6);
      ASSERT_FLOAT_EQ(decode(texel.data(), 1), static_cast<float>(v)) << "alpha";
    }
  }
}

}  // namespace
}  // namespace pelage
