// SPDX-License-Identifier: Apache-2.0
#include "image/texel_decoder.h"

#include <cmath>

#include <Imath/half.h>

namespace pelage {

float from_srgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }

float stored_number(const std::byte* value, TexelKind kind) {
  switch (kind) {
    case TexelKind::kU8:
      return static_cast<float>(static_cast<uint8_t>(*value)) * (1.0f / 255);
    case TexelKind::kU16: {
      uint16_t v;
      std::memcpy(&v, value, sizeof v);
      return static_cast<float>(v) * (1.0f / 65535);
    }
    case TexelKind::kHalf: {
      half v;
      std::memcpy(&v, value, sizeof v);
      return v;
    }
    case TexelKind::kFloat:
      break;
  }
  float v;
  std::memcpy(&v, value, sizeof v);
  return v;
}

TexelDecoder::TexelDecoder(const TexelLayout& layout, bool srgb) : kind_(layout.kind), colors_(0) {
  const bool has_alpha = layout.channels == 2 || layout.channels == 4;
  if (srgb) colors_ = layout.channels - (has_alpha ? 1 : 0);
  if (kind_ == TexelKind::kFloat) return;
  const size_t count = kind_ == TexelKind::kU8 ? 1 << 8 : 1 << 16;
  const auto number = [&](size_t i) {
    const auto small = static_cast<uint8_t>(i);
    const auto wide = static_cast<uint16_t>(i);
    const void* at = kind_ == TexelKind::kU8 ? static_cast<const void*>(&small) : &wide;
    return stored_number(static_cast<const std::byte*>(at), kind_);
  };
  if (colors_ < layout.channels) {
    linear_.resize(count);
    for (size_t i = 0; i < count; ++i) linear_[i] = number(i);
  }
  if (colors_ > 0) {
    color_.resize(count);
    for (size_t i = 0; i < count; ++i) color_[i] = from_srgb(number(i));
  }
}

}  // namespace pelage
