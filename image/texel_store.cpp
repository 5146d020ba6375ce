// SPDX-License-Identifier: Apache-2.0
#include "image/texel_store.h"

#include <cstring>

#include "base/check.h"

namespace pelage {

TexelsInMemory::TexelsInMemory(const TexelLayout& layout, std::vector<NumberRange> ranges,
                               std::vector<std::byte> texels)
    : TexelStore(layout, std::move(ranges)), texels_(std::move(texels)) {
  PELAGE_CHECK(texels_.size() == layout.bytes());
  set_in_memory(texels_.data());
}

void TexelsInMemory::read(int x, int y, int width, int height, std::byte* to) const {
  const size_t texel = layout().texel_bytes(), row = layout().row_bytes();
  const size_t count = static_cast<size_t>(width) * texel;
  const std::byte* from = texels_.data() + static_cast<size_t>(y) * row + static_cast<size_t>(x) * texel;
  for (int i = 0; i < height; ++i, from += row, to += count) std::memcpy(to, from, count);
}

}  // namespace pelage
