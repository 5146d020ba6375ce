// SPDX-License-Identifier: Apache-2.0
#include "lab/report/png.h"

#include <algorithm>
#include <cstdint>
#include <new>

#include <png.h>

#include "base/check.h"

namespace pelage {

std::string png_bytes(const Picture& picture) {
  PELAGE_CHECK(picture.channels == 1 || picture.channels == 3);
  PELAGE_CHECK(picture.width > 0 && picture.height > 0 &&
               picture.pixels.size() == static_cast<size_t>(picture.width) *
                                            static_cast<size_t>(picture.channels) *
                                            static_cast<size_t>(picture.height));
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = picture.channels == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB;
  png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string png(bytes, '\0');
  // Can fail only for lack of memory: the buffer holds the worst case.
  if (!png_image_write_to_memory(&image, png.data(), &bytes, 0, picture.pixels.data(), 0, nullptr))
    throw std::bad_alloc();
  png.resize(bytes);
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
