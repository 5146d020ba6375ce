// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pelage {

/// How finely numbers are kept. Whatever is chosen gives the same floats back.
enum class Precision : uint8_t {
  kFloat,
  kUnorm16,  ///< multiples of 1/65535 in [0, 1]
  kUnorm8,   ///< multiples of 1/255 in [0, 1], which are multiples of 1/65535 too
};
inline size_t precision_bytes(Precision precision) {
  return precision == Precision::kFloat ? 4 : precision == Precision::kUnorm16 ? 2 : 1;
}

/// What becomes of a number that is packed: in [0, 1] the nearest multiple of 1/65535 (0 and 1 stay what they
/// are, the error is at most 2^-17), elsewhere itself. A function of the number alone: how strands are
/// divided into chunks never reaches a pixel.
float packed_value(float x);

/// The coarsest precision that gives `values` back, which are packed_value()s or anything else.
Precision coarsest_precision(std::span<const float> values);

/// Writes `values` in a precision that holds them; `out` is aligned for it.
void pack_values(std::span<const float> values, Precision precision, std::byte* out);

/// Number `index` of packed numbers.
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
