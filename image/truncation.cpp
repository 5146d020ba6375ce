// SPDX-License-Identifier: Apache-2.0
#include "image/truncation.h"

#include <cstddef>
#include <cstdint>

namespace pelage {
namespace {

using namespace std::string_view_literals;

uint32_t byte(std::string_view file, size_t at) { return static_cast<unsigned char>(file[at]); }

/// Chunks of length, type, data and checksum, up to one of type IEND.
bool png_is_cut(std::string_view file) {
  for (size_t at = 8; at + 12 <= file.size();) {
    const uint64_t length =
        byte(file, at) << 24 | byte(file, at + 1) << 16 | byte(file, at + 2) << 8 | byte(file, at + 3);
    if (file.substr(at + 4, 4) == "IEND") return false;
    at += 12 + length;
  }
  return true;
}

/// Marker segments, the entropy-coded data after a start of scan being passed over, up to the end of image.
bool jpeg_is_cut(std::string_view file) {
  constexpr uint32_t kEnd = 0xd9;
  for (size_t at = 2; at + 1 < file.size();) {
    const uint32_t marker = byte(file, at + 1);
    const bool is_marker = byte(file, at) == 0xff && marker != 0 && marker != 0xff;
    const bool stands_alone = marker == 1 || (marker >= 0xd0 && marker <= 0xd8);
    if (!is_marker) {
      ++at;  // coded data or filling
    } else if (marker == kEnd) {
      return false;
    } else if (stands_alone) {
      at += 2;
    } else if (at + 3 < file.size()) {
      at += 2 + (byte(file, at + 2) << 8 | byte(file, at + 3));
    } else {
      return true;
    }
  }
  return true;
}

}  // namespace

bool is_cut_short(std::string_view file) {
  if (file.starts_with("\x89PNG\r\n\x1a\n"sv)) return png_is_cut(file);
  if (file.starts_with("\xff\xd8\xff"sv)) return jpeg_is_cut(file);
  return false;
}

}  // namespace pelage
