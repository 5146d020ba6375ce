// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "image/texel_layout.h"

namespace pelage {

/// Converts an sRGB-encoded value to a linear value [IEC 61966-2-1].
float from_srgb(float v);

/// Returns a stored value as a float. Integers are mapped to 0 .. 1.
float stored_number(const std::byte* value, TexelKind kind);

/// Converts stored values of texels to linear values. The last of two or four channels is alpha, which is
/// always linear. Values of one or two bytes are looked up in a table. Immutable and thread safe.
class TexelDecoder {
 public:
  /// `srgb`: whether the channels other than alpha are sRGB-encoded.
  TexelDecoder(const TexelLayout& layout, bool srgb);

  /// Returns the linear value of one channel of the texel that `texel` points to.
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
  /// Converts the result of stored_number() for a channel to a linear value. The conversion is monotonic.
  float linear(float number, int channel) const { return is_color(channel) ? from_srgb(number) : number; }
  /// Heap memory.
  size_t bytes() const { return (color_.size() + linear_.size()) * sizeof(float); }

 private:
  bool is_color(int channel) const { return channel < colors_; }

  TexelKind kind_;
  int colors_;  // count of sRGB-encoded channels; they come first
  std::vector<float> color_, linear_;
};

}  // namespace pelage
