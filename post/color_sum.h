// SPDX-License-Identifier: Apache-2.0
// Tested in tests/post/motion_blur_test.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace pelage {

/// Sums of colours use colours divided by a power of two, so that the largest floats stay finite with the
/// weights of the longest shutter (4096 steps of 8 x 8 samples). Results are unaffected except for colours
/// below 1e-32.
inline constexpr float kColorSumScale = 0x1p-20f;

/// NaN counts as zero.
inline float color_to_sum(float color) { return color == color ? color * kColorSumScale : 0; }

/// Converts a mean of color_to_sum() values back. Finite for finite colours; zero where infinities cancel.
inline float color_of_mean(float mean) {
  if (mean != mean) return 0;
  if (std::isinf(mean)) return mean;
  constexpr float kLargest = std::numeric_limits<float>::max();
  return std::clamp(mean * (1 / kColorSumScale), -kLargest, kLargest);
}

}  // namespace pelage
