// SPDX-License-Identifier: Apache-2.0
#include "cli/report/png.h"

#include <algorithm>
#include <cstdint>

#include "base/check.h"

namespace pelage {
namespace {

void append_u32(std::string& out, uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>((value >> shift) & 0xFF);
}

uint32_t crc32(std::string_view bytes) {
  uint32_t crc = 0xFFFFFFFFu;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) ? 0xEDB88320u : 0);
  }
  return ~crc;
}

uint32_t adler32(std::string_view bytes) {
  uint32_t a = 1, b = 0;
  for (const char c : bytes) {
    a = (a + static_cast<unsigned char>(c)) % 65521;
    b = (b + a) % 65521;
  }
  return b << 16 | a;
}

void append_chunk(std::string& out, std::string_view type, std::string_view data) {
  append_u32(out, static_cast<uint32_t>(data.size()));
  std::string body(type);
  body += data;
  out += body;
  append_u32(out, crc32(body));
}

// A zlib stream of stored blocks.
std::string stored(std::string_view bytes) {
  std::string out = "\x78\x01";
  constexpr size_t kMost = 65535;
  for (size_t at = 0; at < bytes.size(); at += kMost) {
    const size_t length = std::min(kMost, bytes.size() - at);
    out += static_cast<char>(at + length == bytes.size());
    for (const size_t word : {length, ~length}) {
      out += static_cast<char>(word & 0xFF);
      out += static_cast<char>((word >> 8) & 0xFF);
    }
    out += bytes.substr(at, length);
  }
  append_u32(out, adler32(bytes));
  return out;
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
  std::string rows;
  for (int y = 0; y < picture.height; ++y) {
    rows += '\0';
    rows.append(reinterpret_cast<const char*>(&picture.pixels[row * static_cast<size_t>(y)]), row);
  }
  std::string png = "\x89PNG\r\n\x1a\n";
  append_chunk(png, "IHDR", header);
  append_chunk(png, "IDAT", stored(rows));
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
