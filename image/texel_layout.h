// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace pelage {

/// Type in which one channel of a texel is stored. Values of files with other types are converted to kFloat.
enum class TexelKind { kU8, kU16, kHalf, kFloat };

/// Size of one value in bytes.
inline size_t value_bytes(TexelKind kind) {
  return kind == TexelKind::kU8 ? 1 : kind == TexelKind::kFloat ? 4 : 2;
}

/// Size and type of an image in memory. Rows run from the top; the channels of a texel are adjacent.
struct TexelLayout {
  int width = 0;
  int height = 0;
  int channels = 0;
  TexelKind kind = TexelKind::kFloat;

  size_t texel_bytes() const { return static_cast<size_t>(channels) * value_bytes(kind); }
  size_t row_bytes() const { return static_cast<size_t>(width) * texel_bytes(); }
  size_t bytes() const { return static_cast<size_t>(height) * row_bytes(); }
};

/// Max size of a texel in bytes: four floats.
constexpr size_t kMaxTexelBytes = 16;

}  // namespace pelage
