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

/// Whether the two-stage rule meets its noise budget on average over the frame or in each pixel.
enum class NoiseGoal { kFrame, kPixel };
template <>
struct EnumNames<NoiseGoal> {
  static constexpr const char* names[] = {"frame", "pixel"};
};

/// `adaptive:` of `render:`.
struct AdaptiveParams {
  AdaptiveRule rule = AdaptiveRule::kTwoStage;
  NoiseGoal goal = NoiseGoal::kFrame;
  float noise = 0.05f;  ///< half of the 95 % confidence interval of a pixel's luminance, relative to its mean
  int pilot = 16;
  int batch = 32;
  static const Schema<AdaptiveParams>& schema();
};

}  // namespace pelage
