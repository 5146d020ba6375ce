// SPDX-License-Identifier: Apache-2.0
#include "lab/report/png.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>

#include <zlib.h>

#include "base/check.h"

namespace pelage {
namespace {

void append_u32(std::string& out, uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>((value >> shift) & 0xFF);
}

const Bytef* as_bytes(std::string_view data) { return reinterpret_cast<const Bytef*>(data.data()); }

void append_chunk(std::string& out, std::string_view type, std::string_view data) {
  append_u32(out, static_cast<uint32_t>(data.size()));
  std::string body(type);
  body += data;
  out += body;
  append_u32(out, static_cast<uint32_t>(crc32(0, as_bytes(body), static_cast<uInt>(body.size()))));
}

std::string deflated(std::string_view bytes) {
  uLongf length = compressBound(bytes.size());
  std::string out(length, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(out.data()), &length, as_bytes(bytes), bytes.size(),
                               Z_BEST_COMPRESSION);
  if (status != Z_OK) throw std::bad_alloc();  // the only thing that can be wrong
  out.resize(length);
  return out;
}

/// What a byte is predicted from: those to the left, above, and above to the left.
struct Neighbours {
  int left = 0, above = 0, corner = 0;
};

/// Filters of rows [PNG, section 9]; the numbers stand in the file.
enum RowFilter : char { kNone, kLeft, kAbove, kAverage, kPaeth, kFilters };

int predicted(RowFilter filter, const Neighbours& n) {
  switch (filter) {
    case kLeft:
      return n.left;
    case kAbove:
      return n.above;
    case kAverage:
      return (n.left + n.above) / 2;
    case kPaeth: {
      const int left = std::abs(n.above - n.corner), above = std::abs(n.left - n.corner),
                corner = std::abs(n.left + n.above - 2 * n.corner);
      if (left <= above && left <= corner) return n.left;
      return above <= corner ? n.above : n.corner;
    }
    default:
      return 0;
  }
}

/// Rows of pixels, each as the differences from what the best of the filters predicts: the one whose
/// differences have the least sum of magnitudes.
std::string filtered(const Picture& picture, size_t row_bytes) {
  const auto step = static_cast<size_t>(picture.channels);
  std::string rows, tried(row_bytes, '\0'), best;
  for (size_t y = 0; y < static_cast<size_t>(picture.height); ++y) {
    const unsigned char* row = &picture.pixels[row_bytes * y];
    const unsigned char* above = y > 0 ? row - row_bytes : nullptr;
    long best_sum = std::numeric_limits<long>::max();
    for (char f = kNone; f < kFilters; ++f) {
      long sum = 0;
      for (size_t i = 0; i < row_bytes; ++i) {
        Neighbours n;
        if (i >= step) n.left = row[i - step];
        if (above) n.above = above[i];
        if (above && i >= step) n.corner = above[i - step];
        const auto difference = static_cast<signed char>(row[i] - predicted(static_cast<RowFilter>(f), n));
        tried[i] = static_cast<char>(difference);
        sum += std::abs(int{difference});
      }
      if (sum >= best_sum) continue;
      best_sum = sum;
      best = f + tried;
    }
    rows += best;
  }
  return rows;
}

}  // namespace

std::string png_bytes(const Picture& picture) {
  PELAGE_CHECK(picture.channels == 1 || picture.channels == 3);
  const size_t row = static_cast<size_t>(picture.width) * static_cast<size_t>(picture.channels);
  PELAGE_CHECK(picture.width > 0 && picture.height > 0 &&
               picture.pixels.size() == row * static_cast<size_t>(picture.height));
  std::string header;
  append_u32(header, static_cast<uint32_t>(picture.width));
  append_u32(header, static_cast<uint32_t>(picture.height));
  // 8 bits, grey or RGB, deflate, filtered by row, not interlaced.
  header += {8, static_cast<char>(picture.channels == 1 ? 0 : 2), 0, 0, 0};
  std::string png = "\x89PNG\r\n\x1a\n";
  append_chunk(png, "IHDR", header);
  append_chunk(png, "IDAT", deflated(filtered(picture, row)));
  append_chunk(png, "IEND", {});
  return png;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t at = 0; at < bytes.size(); at += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - at);
    uint32_t word = 0;
    for (size_t i = 0; i < 3; ++i)
      word = word << 8 | (i < count ? static_cast<unsigned char>(bytes[at + i]) : 0u);
    for (size_t i = 0; i < 4; ++i) out += i <= count ? kDigits[(word >> (18 - 6 * i)) & 63] : '=';
  }
  return out;
}

}  // namespace pelage
