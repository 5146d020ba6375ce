// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace pelage {

/// Factors on the widths of a coat's strands, by the fraction of the strands that are kept (the share). They
/// correct Simplification::gain() for how the strands of the coat overlap: the wide strands of a clump cover
/// more than the strands that they replace.
struct WidthFit {
  static constexpr size_t kQuarterings = 3;

  /// At the shares 1, 1/4, 1/16 and 1/64. The first is 1. No factor is below 0.6 times its predecessor, so
  /// that a smaller share never needs thinner strands.
  std::array<float, kQuarterings + 1> factors = [] {
    std::array<float, kQuarterings + 1> ones{};
    ones.fill(1);
    return ones;
  }();

  /// Returns the factor at a share in (0, 1]: linear in the logarithm of the share, constant beyond the last.
  float at(float share) const {
    if (share >= 1) return 1;
    const float quarterings = std::min(-0.5f * std::log2(share), static_cast<float>(kQuarterings));
    const auto before = std::min(static_cast<size_t>(quarterings), kQuarterings - 1);
    const float t = quarterings - static_cast<float>(before);
    return factors[before] * (1 - t) + factors[before + 1] * t;
  }

  /// Returns the factor at `share`, relative to the factor of a coat with 1 / `fraction` times as many
  /// strands.
  float ratio(float share, float fraction) const { return at(share) / at(std::min(1.0f, share / fraction)); }
  /// Returns the end of the range of shares that begins at `share` and in which ratio() is monotonic: there
  /// it is a quotient of two functions that are linear in the logarithm of the share. At most 1.
  float end_of_range(float share, float fraction) const {
    float end = 1, quartered = 1;
    for (size_t i = 0; i <= kQuarterings; ++i, quartered /= 4) {
      for (const float knot : {quartered, quartered * fraction}) {
        if (knot > share) end = std::min(end, knot);
      }
    }
    return end;
  }
};

}  // namespace pelage
