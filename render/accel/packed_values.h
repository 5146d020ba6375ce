// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pelage {

/// Storage format of packed floats. A format is chosen only for floats that it stores without loss, so every
/// format restores exactly the floats that were packed.
enum class Precision : uint8_t {
  kFloat,
  kUnorm16,  ///< multiples of 1/65535 in [0, 1]
  kUnorm8,   ///< multiples of 1/255 in [0, 1], which are multiples of 1/65535 too
};
inline size_t precision_bytes(Precision precision) {
  return precision == Precision::kFloat ? 4 : precision == Precision::kUnorm16 ? 2 : 1;
}

/// Returns `x` rounded for packing. A value in [0, 1] is rounded to the nearest multiple of 1/65535: 0 and 1
/// stay exact, and the max error is about 2^-17. Any other value is returned unchanged. The result depends on
/// `x` alone, so the division of strands into chunks never affects a pixel.
float packed_value(float x);

/// Returns the coarsest precision that restores all `values` bit by bit. The values need not have been
/// rounded by packed_value().
Precision coarsest_precision(std::span<const float> values);

/// Writes `values` to `out`. The caller must choose a precision that restores them exactly, for example
/// coarsest_precision(). `out` must be aligned to precision_bytes(precision).
void pack_values(std::span<const float> values, Precision precision, std::byte* out);

/// Returns element `index` of the values that pack_values() wrote with the same precision.
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
