// SPDX-License-Identifier: Apache-2.0
#include "image/truncation.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace pelage {
namespace {

using namespace std::string_view_literals;

/// Random access to the bytes of a stream, of which a window is in memory.
class Bytes {
 public:
  explicit Bytes(std::istream& file) : file_(file) {
    file_.clear();
    file_.seekg(0, std::ios::end);
    const std::streamoff end = file_.tellg();
    size_ = end > 0 ? static_cast<uint64_t>(end) : 0;
  }

  uint64_t size() const { return size_; }
  /// 0 once the stream cannot be read.
  uint32_t at(uint64_t place) {
    if (place - begin_ >= window_.size()) {
      window_.assign(kWindow, '\0');
      file_.clear();
      file_.seekg(static_cast<std::streamoff>(place));
      file_.read(window_.data(), kWindow);
      begin_ = place;
    }
    return static_cast<unsigned char>(window_[place - begin_]);
  }
  bool has(uint64_t place, std::string_view text) {
    if (place + text.size() > size_) return false;
    for (size_t i = 0; i < text.size(); ++i) {
      if (at(place + i) != static_cast<unsigned char>(text[i])) return false;
    }
    return true;
  }

 private:
  static constexpr size_t kWindow = 1 << 16;
  std::istream& file_;
  uint64_t size_ = 0;
  uint64_t begin_ = 0;
  std::string window_;
};

bool is_png(Bytes& file) { return file.has(0, "\x89PNG\r\n\x1a\n"sv); }
bool is_jpeg(Bytes& file) { return file.has(0, "\xff\xd8\xff"sv); }

/// Reads chunks of length, type, data and checksum, up to one of type IEND.
bool png_is_cut(Bytes& file) {
  for (uint64_t at = 8; at + 12 <= file.size();) {
    const uint64_t length =
        file.at(at) << 24 | file.at(at + 1) << 16 | file.at(at + 2) << 8 | file.at(at + 3);
    if (file.has(at + 4, "IEND"sv)) return false;
    at += 12 + length;
  }
  return true;
}

constexpr uint32_t kEndOfImage = 0xd9, kProgressiveFrame = 0xc2;

/// Searches the marker segments of a JPEG, skipping the entropy-coded data after a start of scan, for the
/// first one of type `wanted`. Returns its position, or 0 when the end of the image or file comes first.
uint64_t find_marker(Bytes& file, uint32_t wanted) {
  for (uint64_t at = 2; at + 1 < file.size();) {
    const uint32_t marker = file.at(at + 1);
    const bool is_marker = file.at(at) == 0xff && marker != 0 && marker != 0xff;
    const bool stands_alone = marker == 1 || (marker >= 0xd0 && marker <= 0xd8);
    if (!is_marker) {
      ++at;  // coded data or padding
    } else if (marker == wanted) {
      return at;
    } else if (marker == kEndOfImage) {
      return 0;
    } else if (stands_alone) {
      at += 2;
    } else if (at + 3 < file.size()) {
      at += 2 + (file.at(at + 2) << 8 | file.at(at + 3));
    } else {
      return 0;
    }
  }
  return 0;
}

}  // namespace

bool is_cut_short(std::istream& stream) {
  Bytes file(stream);
  if (is_png(file)) return png_is_cut(file);
  return is_jpeg(file) && find_marker(file, kEndOfImage) == 0;
}

int64_t interlaced_bytes(std::istream& stream) {
  constexpr uint64_t kPngInterlace = 28;
  constexpr int64_t kPngTexel = 8;  // the largest: four channels of two bytes
  Bytes file(stream);
  const auto number = [&](uint64_t at, int bytes) {
    int64_t value = 0;
    for (int i = 0; i < bytes; ++i) value = value << 8 | file.at(at + static_cast<uint64_t>(i));
    return std::min(value, int64_t(1) << 20);
  };
  if (is_png(file)) {
    if (file.size() <= kPngInterlace || file.at(kPngInterlace) == 0) return 0;
    return number(16, 4) * number(20, 4) * kPngTexel;
  }
  if (!is_jpeg(file)) return 0;
  // Marker, length, precision, height, width, number of components; two bytes per coefficient.
  const uint64_t frame = find_marker(file, kProgressiveFrame);
  if (frame == 0 || frame + 10 > file.size()) return 0;
  return number(frame + 5, 2) * number(frame + 7, 2) * number(frame + 9, 1) * 2;
}

}  // namespace pelage
