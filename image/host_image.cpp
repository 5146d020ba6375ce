// SPDX-License-Identifier: Apache-2.0
#include "image/host_image.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include "base/error.h"
#include "base/hash.h"

namespace pelage {

void HostImage::read(ImageSink& sink) const {
  constexpr size_t kStripBytes = size_t(1) << 20;
  const bool is_integer = layout_.kind == TexelKind::kU8 || layout_.kind == TexelKind::kU16;
  sink.begin({layout_, is_integer, 0});
  const size_t row = layout_.row_bytes();
  const int strip = static_cast<int>(std::clamp<size_t>(kStripBytes / row, 1, 65536));
  for (int y = 0; y < layout_.height; y += strip)
    sink.rows(texels_.data() + static_cast<size_t>(y) * row, std::min(strip, layout_.height - y));
}

std::shared_ptr<const HostImage> share_image(const TexelLayout& layout, std::vector<std::byte> texels) {
  const auto [width, height, channels, kind] = layout;
  if (width < 1 || height < 1 || channels < 1 || channels > 4) {
    throw Error(ErrorKind::kInput, fmt::format("an image needs texels of 1 to 4 channels, got {} x {} of {}",
                                               width, height, channels));
  }
  if (texels.size() != layout.bytes())
    throw Error(ErrorKind::kInput,
                fmt::format("an image of {} bytes needs {}", texels.size(), layout.bytes()));
  ContentHasher hasher;
  for (const int number : {width, height, channels, static_cast<int>(kind)})
    hasher.add(static_cast<uint64_t>(number));
  hasher.add_bytes(texels);
  return std::make_shared<HostImage>("image:" + to_string(hasher.digest()), layout, std::move(texels));
}

}  // namespace pelage
