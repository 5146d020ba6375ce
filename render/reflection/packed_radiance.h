// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#include "base/vector.h"

namespace pelage {

/// A radiance in 64 bits: per channel a float without sign, with 8 bits of exponent and 13 of mantissa. The
/// error is at most 2^-14 of each channel, if that is a normal float. Channels that are negative or not a
/// number become 0.
class PackedRadiance {
 public:
  static uint64_t pack(const Rgb& radiance) {
    return channel(radiance.x) | channel(radiance.y) << kBits | channel(radiance.z) << 2 * kBits;
  }
  static Rgb unpack(uint64_t packed) {
    return {value(packed), value(packed >> kBits), value(packed >> 2 * kBits)};
  }

 private:
  static constexpr int kBits = 21, kLeftOut = 31 - kBits;  // the last bits of a mantissa
  static constexpr uint32_t kMask = (1u << kBits) - 1;

  static uint64_t channel(float value) {
    constexpr uint32_t kHalf = 1u << (kLeftOut - 1);
    const uint32_t most = std::bit_cast<uint32_t>(std::numeric_limits<float>::max()) >> kLeftOut;
    if (!(value > 0)) return 0;
    return std::min((std::bit_cast<uint32_t>(value) + kHalf) >> kLeftOut, most);
  }
  static float value(uint64_t channels) {
    return std::bit_cast<float>((static_cast<uint32_t>(channels) & kMask) << kLeftOut);
  }
};

}  // namespace pelage
