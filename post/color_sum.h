// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace pelage {

/// Factor on colours before they are added up. With this factor, the sum of the largest finite floats stays
/// finite for the max number of samples of a pixel (4096 steps of 8 x 8 samples). The factor is a power of
/// two, so it does not change results, except for colours below 1e-32.
inline constexpr float kColorSumScale = 0x1p-20f;

/// Converts a colour to a summand of a sum. NaN becomes zero.
inline float color_to_sum(float color) { return color == color ? color * kColorSumScale : 0; }

/// Converts a mean of color_to_sum() values to a colour. The colour is finite if all summands were finite. It
/// is zero if infinite summands had different signs.
inline float color_of_mean(float mean) {
  if (mean != mean) return 0;
  if (std::isinf(mean)) return mean;
  constexpr float kLargest = std::numeric_limits<float>::max();
  return std::clamp(mean * (1 / kColorSumScale), -kLargest, kLargest);
}

}  // namespace pelage
