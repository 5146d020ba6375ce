// SPDX-License-Identifier: Apache-2.0
#include "image/exr.h"

#include <cmath>
#include <csignal>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/temporary_folder.h"
#include "tests/support/data.h"

namespace pelage {
namespace {

ExrImage example(int width, int height) {
  ExrImage image;
  image.width = width;
  image.height = height;
  const size_t count = static_cast<size_t>(width) * static_cast<size_t>(height);
  const auto channel = [&](const char* name, ChannelType type) {
    ExrChannel c{name, type, {}, {}};
    for (size_t i = 0; i < count; ++i) {
      const uint64_t h = hash64(i, image.channels.size());
      if (type == ChannelType::kUint) {
        c.ids.push_back(static_cast<uint32_t>(h));
      } else {
        c.pixels.push_back(type == ChannelType::kHalf ? static_cast<float>(h % 1024) / 64 : signed_float(h));
      }
    }
    image.channels.push_back(std::move(c));
  };
  // In the order in which files keep them.
  channel("A", ChannelType::kHalf);
  channel("R", ChannelType::kHalf);
  channel("Z", ChannelType::kFloat);
  channel("forward.u", ChannelType::kFloat);
  channel("id", ChannelType::kUint);
  channel("key.diffuse.R", ChannelType::kHalf);
  return image;
}

std::string message_of(const std::filesystem::path& path) {
  try {
    read_exr(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    const std::string text = error.what();
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    EXPECT_EQ(text.find(path.string()), 0u) << text;
    return text.substr(std::min(text.size(), path.string().size()));
  }
  ADD_FAILURE() << "no error";
  return {};
}

TEST(Exr, ChannelsThatAFileWouldMixAreRefused) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& first, const std::string& second) -> std::string {
    ExrImage image = example(2, 2);
    image.channels[0].name = first;
    image.channels[1].name = second;
    try {
      write_exr(folder.path() / "a.exr", image);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kFailed);
      EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal("key.R", "key.R").find("channel 'key.R' occurs twice"), std::string::npos);
  EXPECT_NE(refusal(std::string("key\0a", 5), std::string("key\0b", 5)).find("zero byte"), std::string::npos);
  EXPECT_NE(refusal(std::string(256, 'a'), "b").find("255 bytes"), std::string::npos);
  EXPECT_NE(refusal("", "b").find("no name"), std::string::npos);
  EXPECT_EQ(refusal(std::string(255, 'a'), std::string(254, 'a')), "");
  const ExrImage back = read_exr(folder.path() / "a.exr");
  EXPECT_TRUE(back.find(std::string(255, 'a')) && back.find(std::string(254, 'a')));
}

TEST(Exr, AFileThatMayNotGrowIsAFailureWhereverItEnds) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.exr";
  const ExrImage image = example(20, 40);
  write_exr(path, image);
  const std::string before = read_file(path);
  ::signal(SIGXFSZ, SIG_IGN);
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
  std::vector<size_t> written;
  for (size_t size = 0; size < before.size(); size += size < 64 || size + 64 > before.size() ? 1 : 61) {
    const rlimit cut{size, old.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &cut);
    try {
      write_exr(path, image);
      written.push_back(size);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kFailed);
    }
    ::setrlimit(RLIMIT_FSIZE, &old);
  }
  ::signal(SIGXFSZ, SIG_DFL);
  EXPECT_TRUE(written.empty()) << written.front();
  EXPECT_EQ(read_file(path), before);
}

TEST(Exr, ComesBackBitForBit) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "new" / "a.exr";
  ExrImage image = example(37, 300);
  image.channels[2].pixels[5] = std::numeric_limits<float>::infinity();
  image.attributes = {{"samples", 64},
                      {"renderTime", 1.5f},
                      {"comments", std::string("two\nlines")},
                      {"jitter", V2f(1, 2)},
                      {"eye", V3f(1, 2, 3)},
                      {"worldToCamera", M44f(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16)}};
  write_exr(path, image);
  const ExrImage back = read_exr(path);
  EXPECT_EQ(back.width, 37);
  EXPECT_EQ(back.height, 300);
  ASSERT_EQ(back.channels.size(), image.channels.size());
  for (size_t i = 0; i < image.channels.size(); ++i) {
    EXPECT_EQ(back.channels[i].name, image.channels[i].name);
    EXPECT_EQ(back.channels[i].type, image.channels[i].type);
    EXPECT_EQ(back.channels[i].pixels, image.channels[i].pixels);
    EXPECT_EQ(back.channels[i].ids, image.channels[i].ids);
  }
  for (const auto& [name, value] : image.attributes) {
    ASSERT_TRUE(back.attributes.contains(name)) << name;
    EXPECT_EQ(back.attributes.at(name), value) << name;
  }
  EXPECT_EQ(back.find("id")->type, ChannelType::kUint);
  EXPECT_EQ(back.find("nothing"), nullptr);
}

TEST(Exr, WritesTheSameBytesAgain) {
  const TemporaryFolder folder;
  write_exr(folder.path() / "a.exr", example(64, 64));
  write_exr(folder.path() / "b.exr", example(64, 64));
  EXPECT_EQ(read_file(folder.path() / "a.exr"), read_file(folder.path() / "b.exr"));
}

TEST(Exr, StatesItsChromaticities) {
  const TemporaryFolder folder;
  write_exr(folder.path() / "a.exr", example(4, 4));
  EXPECT_NE(read_file(folder.path() / "a.exr").find("chromaticities"), std::string::npos);
}

TEST(Exr, HalvesAreRoundedAndStayFinite) {
  const TemporaryFolder folder;
  ExrImage image;
  image.width = 5;
  image.height = 1;
  const float infinity = std::numeric_limits<float>::infinity();
  image.channels.push_back({"R", ChannelType::kHalf, {1.0f + 0x1p-12f, 1e9f, -1e9f, infinity, 65519}, {}});
  write_exr(folder.path() / "a.exr", image);
  EXPECT_EQ(read_exr(folder.path() / "a.exr").channels[0].pixels,
            (std::vector<float>{1.0f, 65504, -65504, infinity, 65504}));
}

TEST(Exr, SaysWhereItCannotWriteAndLeavesNothing) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "x";
  try {
    write_exr(folder.path() / "file" / "a.exr", example(4, 4));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kFailed);
    EXPECT_NE(std::string(error.what()).find("a.exr"), std::string::npos) << error.what();
  }
}

TEST(Exr, RefusesWhatIsNotOne) {
  const TemporaryFolder folder;
  EXPECT_EQ(message_of(folder.path() / "none.exr"), ": there is no such file");
  EXPECT_EQ(message_of(folder.path()), ": is not a regular file");
  std::ofstream(folder.path() / "text.exr") << "this is no picture";
  EXPECT_EQ(message_of(folder.path() / "text.exr"), ": is not an EXR file");
  std::ofstream(folder.path() / "pointer.exr") << "version https://git-lfs.github.com/spec/v1\n";
  EXPECT_EQ(message_of(folder.path() / "pointer.exr"), ": is a git-lfs pointer, not the file itself");
  std::ofstream(folder.path() / "empty.exr") << "";
  EXPECT_EQ(message_of(folder.path() / "empty.exr"), ": is not an EXR file");
}

TEST(Exr, RefusesEveryTruncation) {
  const TemporaryFolder folder;
  write_exr(folder.path() / "a.exr", example(64, 40));
  const std::string whole = read_file(folder.path() / "a.exr");
  for (size_t length = 0; length < whole.size(); length += length < 900 ? 37 : 501) {
    const std::filesystem::path path = folder.path() / "cut.exr";
    std::ofstream(path, std::ios::binary).write(whole.data(), static_cast<std::streamsize>(length));
    message_of(path);
  }
}

/// `whole` with 4 bytes changed at `offset` past the end of `mark`.
std::string patched(std::string whole, std::string_view mark, size_t offset, uint32_t value) {
  const size_t at = whole.find(mark) + mark.size() + offset;
  for (size_t i = 0; i < 4; ++i) whole[at + i] = static_cast<char>(value >> (8 * i));
  return whole;
}

TEST(Exr, RefusesHeadersThatClaimTooMuch) {
  const TemporaryFolder folder;
  write_exr(folder.path() / "a.exr", example(64, 40));
  const std::string whole = read_file(folder.path() / "a.exr");
  const auto error = [&](const std::string& bytes) {
    std::ofstream(folder.path() / "b.exr", std::ios::binary) << bytes;
    return message_of(folder.path() / "b.exr");
  };
  const std::string window("dataWindow\0box2i\0", 17);
  EXPECT_EQ(error(patched(whole, window, 12, 0x7fffffff)), ": claims to have 2147483648 x 40 pixels");
  EXPECT_EQ(error(patched(whole, window, 16, 0xffffff00)), ": claims to have 64 x -255 pixels");
  EXPECT_EQ(error(patched(whole, window, 0, 0x70000000)),
            ": attribute 'dataWindow' claims 1879048192 bytes, more than the file has");
  EXPECT_EQ(error(patched(whole, window, 0, 0xffffffff)),
            ": attribute 'dataWindow' claims -1 bytes, more than the file has");
  // The library reads as many bytes as a type has, and then takes what follows for the next attribute.
  EXPECT_EQ(error(patched(whole, window, 0, 17)), ": attribute 'dataWindow' is shorter than it claims");
  const std::string channels("channels\0chlist\0", 16);
  const auto channel_bytes = static_cast<unsigned char>(whole[whole.find(channels) + channels.size()]);
  EXPECT_EQ(error(patched(whole, channels, 0, channel_bytes + 1u)),
            ": attribute 'channels' is shorter than it claims");
  // Rows that the file does not hold: read as far as they go, then refused.
  EXPECT_NE(error(patched(whole, window, 16, 60000)), "");
}

TEST(Exr, ReadsTheFirstPartOfOthersFiles) {
  PELAGE_REQUIRE_DATA();
  const ExrImage beach = read_exr(data_folder() / "exr/Beachball_multipart.0001.exr");
  EXPECT_EQ(beach.width, 877);  // the data window; the display window has 2048 x 1556
  EXPECT_EQ(beach.height, 876);
  EXPECT_EQ(beach.channels.size(), 4u);
  EXPECT_EQ(std::get<std::string>(beach.attributes.at("view")), "right");
  const ExrImage crypto = read_exr(data_folder() / "exr/cryptomatte_cornellBox.0001.exr");
  EXPECT_EQ(crypto.channels.size(), 50u);
  EXPECT_EQ(crypto.find("uCryptoWildcard00.R")->type, ChannelType::kFloat);
  EXPECT_EQ(crypto.channels[0].pixels.size(), 626u * 540u);
}

}  // namespace
}  // namespace pelage
