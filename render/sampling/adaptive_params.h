// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "base/value_readers.h"

namespace pelage {

/// Whether the noise budget is met on average over the frame, or in each pixel.
enum class NoiseGoal { kFrame, kPixel };
template <>
struct EnumNames<NoiseGoal> {
  static constexpr const char* names[] = {"frame", "pixel"};
};

/// `adaptive:` of `render:`.
struct AdaptiveParams {
  NoiseGoal goal = NoiseGoal::kFrame;
  /// Noise budget: half width of the 95 % confidence interval of a pixel's luminance, divided by the mean.
  float noise = 0.05f;
  int pilot = 16;  ///< samples per pixel before the counts are determined
  static const Schema<AdaptiveParams>& schema();
};

}  // namespace pelage
