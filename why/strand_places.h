// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "geom/strands.h"

namespace pelage {

/// A strand at its root, in its middle and at its tip, when the shutter opens. The middle is where the curve
/// has as many segments before it as after it.
struct StrandPlaces {
  static constexpr std::array<const char*, 3> kNames{"root", "middle", "tip"};

  std::array<V3f, 3> position;
  std::array<float, 3> width;               ///< diameter
  std::optional<std::array<Rgb, 3>> color;  ///< the attribute `color`, if the strand has one
  float length = 0;                         ///< arc length
};

/// Measures strand 0 of a batch. It must have a segment.
StrandPlaces strand_places(const Strands& strand);

}  // namespace pelage
