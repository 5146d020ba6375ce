// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "base/value_readers.h"

namespace pelage {

enum class AdaptiveRule { kTwoStage, kSeed };
template <>
struct EnumNames<AdaptiveRule> {
  static constexpr const char* names[] = {"two-stage", "seed"};
};

/// Whether the rule `two-stage` meets its noise budget on average over the frame, or in each pixel.
enum class NoiseGoal { kFrame, kPixel };
template <>
struct EnumNames<NoiseGoal> {
  static constexpr const char* names[] = {"frame", "pixel"};
};

/// `adaptive:` of `render:`.
struct AdaptiveParams {
  AdaptiveRule rule = AdaptiveRule::kTwoStage;
  NoiseGoal goal = NoiseGoal::kFrame;
  /// Noise budget: half width of the 95 % confidence interval of a pixel's luminance, divided by the mean.
  float noise = 0.05f;
  int pilot = 16;  ///< rule `two-stage`: samples per pixel before the counts are determined
  int batch = 32;  ///< rule `seed`: samples of a pixel between two checks
  static const Schema<AdaptiveParams>& schema();
};

}  // namespace pelage
