// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

// 16-bit floats for numbers from 0 to a million: zero, or 6 bits of exponent and 10 bits of mantissa.
// nearest() has a relative error of at most 2^-11. Powers of two are exact.
namespace pelage::small_float {

// chosen such that the smallest positive number is slightly above 2^-44
inline constexpr uint32_t kBias = 83u << 10;
inline constexpr uint32_t kMantissaBits = 13;  // number of mantissa bits of a float that are dropped

inline float decode(uint16_t code) {
  const uint32_t bits = (code + kBias) << kMantissaBits;
  return code == 0 ? 0.0f : std::bit_cast<float>(bits);
}

/// Returns the code of `value`. Adds `round_up` to the bits of `value` before it drops mantissa bits: 0 gives
/// the largest number not above `value`, all dropped bits set gives the smallest number not below it. Empty
/// for negative values, NaN and too large values.
inline std::optional<uint16_t> encode(float value, uint32_t round_up) {
  if (value == 0) return uint16_t{0};
  if (!(value > 0) || !std::isfinite(value)) return {};
  const uint32_t bits = (std::bit_cast<uint32_t>(value) + round_up) >> kMantissaBits;
  if (bits <= kBias) return static_cast<uint16_t>(round_up + 1 == 1u << kMantissaBits);
  if (bits - kBias > UINT16_MAX) return {};
  return static_cast<uint16_t>(bits - kBias);
}
inline std::optional<uint16_t> nearest(float value) { return encode(value, 1u << (kMantissaBits - 1)); }
inline std::optional<uint16_t> not_below(float value) { return encode(value, (1u << kMantissaBits) - 1); }

}  // namespace pelage::small_float
