// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pelage {

/// Storage format of numbers. All formats restore the same floats.
enum class Precision : uint8_t {
  kFloat,
  kUnorm16,  ///< multiples of 1/65535 in [0, 1]
  kUnorm8,   ///< multiples of 1/255 in [0, 1], which are multiples of 1/65535 too
};
inline size_t precision_bytes(Precision precision) {
  return precision == Precision::kFloat ? 4 : precision == Precision::kUnorm16 ? 2 : 1;
}

/// Rounds a number for packing. Numbers in [0, 1] are rounded to the nearest multiple of 1/65535 (0 and 1 are
/// exact, the error is at most 2^-17); other numbers are unchanged. The result depends on the number alone,
/// so the division of strands into chunks never affects a pixel.
float packed_value(float x);

/// The coarsest precision that restores `values` exactly, whether they were rounded by packed_value() or not.
Precision coarsest_precision(std::span<const float> values);

/// Writes `values` in a precision that can hold them; `out` must be aligned for it.
void pack_values(std::span<const float> values, Precision precision, std::byte* out);

/// Element `index` of packed numbers.
inline float unpacked_value(const std::byte* packed, Precision precision, size_t index) {
  switch (precision) {
    case Precision::kFloat:
      return reinterpret_cast<const float*>(packed)[index];
    case Precision::kUnorm16:
      return static_cast<float>(reinterpret_cast<const uint16_t*>(packed)[index]) / 65535.0f;
    case Precision::kUnorm8:
      return static_cast<float>(257u * reinterpret_cast<const uint8_t*>(packed)[index]) / 65535.0f;
  }
  return 0;
}

}  // namespace pelage
