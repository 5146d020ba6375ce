// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>

#include "base/parallel.h"
#include "render/fibre/tangle.h"

namespace pelage {

/// Converts the colour of dense fur to the absorption of a single fibre of a model, so that `color` means the
/// same for every model. The reference is an infinite medium of combed Chiang fibres (FibreLay::coat()) whose
/// absorption follows the fit of [Chiang16]. A medium of the converted fibres has the same brightness as the
/// reference. [Chiang16] made the fit for another scene: the reference medium is up to 0.08 brighter than
/// `color`. Combed fibres that let light through are brighter than a tangle of them, opaque ones are not, so
/// the medium must be combed.
///
/// Uses a table over the logarithm of the colour, computed by random walks on construction. The table is
/// bit-identical for any number of threads.
class CoatColor {
 public:
  /// `scatter(t, hit, u)` samples a fibre with absorption `t`. For translucent fibres, t is the absorption
  /// per radius; opaque fibres have the albedo exp(-t). The scattered light must decrease as t increases.
  using Scatter = std::function<std::optional<FibreSample>(float, const TangleHit&, const V3f&)>;
  CoatColor(const Scatter& scatter, const Workers& workers);

  /// Returns the absorption t of each channel. It is 0 where a fibre without absorption is still too dark
  /// because its model loses light.
  Rgb operator()(const Rgb& color) const;

  static constexpr int kColors = 11;
  /// The colours of the table, and the brightness that a medium of Chiang fibres with default roughness has
  /// for each of them.
  static const std::array<float, kColors> kColor, kBrightness;

 private:
  std::array<float, kColors> root_{};  // square root of t for each colour
};

}  // namespace pelage
