// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "image/texel_layout.h"

namespace pelage {

/// Linear value of an sRGB-encoded one [IEC 61966-2-1].
float from_srgb(float v);

/// A stored value as a number: integers are mapped to 0 .. 1.
float stored_number(const std::byte* value, TexelKind kind);

/// Converts stored values to linear ones. The last channel of two or four is alpha, which is already linear.
/// Values of one or two bytes are looked up in a table. Immutable; thread safe.
class TexelDecoder {
 public:
  TexelDecoder(const TexelLayout& layout, bool srgb);

  /// The value of one channel of the texel at `texel`.
  float operator()(const std::byte* texel, int channel) const {
    const auto c = static_cast<size_t>(channel);
    const std::vector<float>& table = is_color(channel) ? color_ : linear_;
    if (kind_ == TexelKind::kU8) return table[static_cast<uint8_t>(texel[c])];
    if (kind_ == TexelKind::kFloat) {
      float v;
      std::memcpy(&v, texel + c * sizeof v, sizeof v);
      return is_color(channel) ? from_srgb(v) : v;
    }
    uint16_t v;
    std::memcpy(&v, texel + c * sizeof v, sizeof v);
    return table[v];
  }
  /// The linear value of a number (see stored_number) of a channel. Monotonic.
  float linear(float number, int channel) const { return is_color(channel) ? from_srgb(number) : number; }
  size_t bytes() const { return (color_.size() + linear_.size()) * sizeof(float); }

 private:
  bool is_color(int channel) const { return channel < colors_; }

  TexelKind kind_;
  int colors_;  // the first channels, this many, are sRGB-encoded
  std::vector<float> color_, linear_;
};

}  // namespace pelage
