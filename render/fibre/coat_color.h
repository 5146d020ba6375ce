// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>

#include "base/parallel.h"
#include "render/fibre/tangle.h"

namespace pelage {

/// Turns the colour of much fur together into what one fibre of a model must absorb, so that `color` means
/// the same for every model: an endless tangle of such fibres is as bright as one of Chiang fibres whose
/// absorption comes from the fit of [Chiang16]. That fit, made for another scene, is the colour of such a
/// tangle to a few hundredths.
///
/// A table over the logarithm of the colour, found by random walks when it is made; the same bit for bit for
/// any number of threads.
class CoatColor {
 public:
  /// `scatter(t, hit, u)` is a fibre that absorbs `t`: per radius for fibres that light goes through, and
  /// with an albedo of exp(-t) for others. What it gives back must fall as t rises.
  using Scatter = std::function<std::optional<FibreSample>(float, const TangleHit&, const V3f&)>;
  CoatColor(const Scatter& scatter, const Workers& workers);

  /// The t of each channel; 0 where even a fibre that absorbs nothing is too dark.
  Rgb operator()(const Rgb& color) const;

  static constexpr int kColors = 11;
  /// Colours of the table, and how bright a tangle of Chiang fibres of default roughness is.
  static const std::array<float, kColors> kColor, kBrightness;

 private:
  std::array<float, kColors> root_{};  // of t
};

}  // namespace pelage
