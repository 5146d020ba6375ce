// SPDX-License-Identifier: Apache-2.0
#include "image/exr_check.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "base/file.h"
#include "base/nearest_name.h"

namespace pelage {
namespace {

constexpr uint32_t kMagic = 20000630;
constexpr uint32_t kLongNames = 0x400, kMultiPart = 0x1000;
constexpr int64_t kLargestSide = 1 << 16;
constexpr int64_t kMaxBlockBytes = int64_t(1) << 29;
/// Blocks larger than this must be in proportion to the file.
constexpr int64_t kAnyBlockBytes = int64_t(1) << 26;
constexpr int64_t kMaxExpansion = 4096;
constexpr int kMaxParts = 1024;

/// Number of rows compressed together, by compression number (none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A,
/// DWAA, DWAB).
constexpr int64_t kBlockRows[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};

/// Sizes of the values that the library reads without checking the length claimed by the file.
struct TypeBytes {
  std::string_view type;
  int64_t bytes;
};
constexpr TypeBytes kTypeBytes[] = {
    {"box2f", 16},
    {"box2i", 16},
    {"chromaticities", 32},
    {"compression", 1},
    {"deepImageState", 1},
    {"double", 8},
    {"envmap", 1},
    {"float", 4},
    {"int", 4},
    {"keycode", 28},
    {"lineOrder", 1},
    {"m33d", 72},
    {"m33f", 36},
    {"m44d", 128},
    {"m44f", 64},
    {"rational", 8},
    {"tiledesc", 9},
    {"timecode", 8},
    {"v2d", 16},
    {"v2f", 8},
    {"v2i", 8},
    {"v3d", 24},
    {"v3f", 12},
    {"v3i", 12},
};

class HeaderWalk {
 public:
  explicit HeaderWalk(const std::filesystem::path& path) : path_(path), stream_(path, std::ios::binary) {
    if (const std::string problem = file_problem(path); !problem.empty()) fail(problem);
    std::error_code error;
    if (!stream_) fail("cannot be opened");
    size_ = static_cast<int64_t>(std::filesystem::file_size(path, error));
  }

  void run() {
    if (size_ < 8 || number() != kMagic) {
      std::string beginning(64, '\0');
      stream_.seekg(0);
      stream_.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
      const std::string_view foreign = foreign_contents(beginning);
      fail(foreign.empty() ? "is not an EXR file" : std::string(foreign));
    }
    const uint32_t version = number();
    longest_name_ = (version & kLongNames) ? 255 : 31;
    int parts = 0;
    while (header()) {
      if (!(version & kMultiPart)) return;
      if (++parts > kMaxParts) fail("has too many parts");
    }
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw Error(ErrorKind::kInput, {path_.string(), 0, 0}, why);
  }

  [[noreturn]] void fail_length(const std::string& attribute) const {
    fail("attribute " + quote(attribute) + " is shorter than it claims");
  }

  void bytes(void* to, int64_t count) {
    stream_.read(static_cast<char*>(to), count);
    if (stream_.gcount() != count) fail("ends inside its header");
  }
  uint32_t number() {
    unsigned char b[4];
    bytes(b, 4);
    return uint32_t(b[0]) | uint32_t(b[1]) << 8 | uint32_t(b[2]) << 16 | uint32_t(b[3]) << 24;
  }
  int64_t signed_number() { return static_cast<int32_t>(number()); }
  std::string name() {
    std::string text;
    for (char c = 0; bytes(&c, 1), c != '\0'; text += c) {
      if (text.size() >= longest_name_) fail("has an unterminated name in its header");
    }
    return text;
  }

  /// Reads one header; false for the empty one that ends the list of a multi-part file.
  bool header() {
    int64_t width = 1, height = 1, pixel_bytes = 0, rows = 1;
    bool is_empty = true;
    for (std::string attribute = name(); !attribute.empty(); attribute = name()) {
      is_empty = false;
      const std::string type = name();
      const int64_t length = signed_number();
      const int64_t begin = stream_.tellg();
      if (length < 0 || length > size_ - begin) {
        fail("attribute " + quote(attribute) + " claims " + std::to_string(length) +
             " bytes, more than the file has");
      }
      for (const TypeBytes& known : kTypeBytes) {
        if (type == known.type && length != known.bytes) fail_length(attribute);
      }
      if (attribute == "dataWindow" && length == 16) {
        const int64_t x0 = signed_number(), y0 = signed_number();
        width = signed_number() - x0 + 1;
        height = signed_number() - y0 + 1;
      } else if (attribute == "compression" && length == 1) {
        unsigned char kind = 0;
        bytes(&kind, 1);
        rows = kind < std::size(kBlockRows) ? kBlockRows[kind] : 256;
      } else if (attribute == "tiles" && length == 9) {
        rows = tile_rows();
      } else if (type == "chlist") {
        const int64_t bytes = channels();
        if (stream_.tellg() != begin + length) fail_length(attribute);
        if (attribute == "channels") pixel_bytes = bytes;
      } else if (type == "preview") {
        const uint64_t pixels = length < 8 ? 0 : uint64_t(number()) * number();
        if (length < 8 || pixels != uint64_t(length - 8) / 4) fail_length(attribute);
      } else if (type == "stringvector") {
        strings(attribute, begin + length);
      }
      stream_.seekg(begin + length);
    }
    if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide) {
      fail("claims to have " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
    }
    const int64_t block = width * pixel_bytes * rows;
    if (block > kMaxBlockBytes || block > std::max(kAnyBlockBytes, kMaxExpansion * size_)) {
      fail("claims rows that are too long for a file of " + std::to_string(size_) + " bytes");
    }
    return !is_empty;
  }

  /// Bytes of one pixel of all channels.
  int64_t channels() {
    int64_t total = 0;
    while (!name().empty()) {
      total += number() == 1 ? 2 : 4;
      stream_.seekg(12, std::ios::cur);
    }
    return total;
  }

  void strings(const std::string& attribute, int64_t end) {
    while (stream_.tellg() < end) {
      const int64_t length = signed_number();
      if (length < 0 || length > end - stream_.tellg()) fail_length(attribute);
      stream_.seekg(length, std::ios::cur);
    }
  }

  int64_t tile_rows() {
    const int64_t width = number(), height = number();
    if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide)
      fail("claims impossible tiles");
    return height;
  }

  const std::filesystem::path& path_;
  std::ifstream stream_;
  int64_t size_ = 0;
  size_t longest_name_ = 31;
};

}  // namespace

void check_exr_headers(const std::filesystem::path& path) { HeaderWalk(path).run(); }

}  // namespace pelage
