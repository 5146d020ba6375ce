// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/vector.h"

namespace pelage {

/// What pilot rays have learned about the visibility of the lights from the neighbourhood of a point: a
/// factor in [0, 1] for each stratum of each light. A stratum is a square of the two random numbers from
/// which a point of the light is drawn.
struct LearnedVisibility {
  static constexpr uint32_t kSide = 4, kStrata = kSide * kSide;

  const uint8_t* factors = nullptr;  ///< by light and stratum, in 255ths; null: nothing is known

  /// Returns the stratum of the random numbers `u` of a light, in [0, 1).
  static uint32_t stratum(const V2f& u) {
    const auto index = [](float x) { return std::min(static_cast<uint32_t>(x * kSide), kSide - 1); };
    return index(u.y) * kSide + index(u.x);
  }
  /// Returns the factor on the probability of tracing a shadow ray to a stratum; 1 if nothing is known.
  float factor(size_t light, uint32_t stratum) const {
    return factors ? static_cast<float>(factors[light * kStrata + stratum]) / 255.0f : 1.0f;
  }
};

}  // namespace pelage
