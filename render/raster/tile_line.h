// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/vector.h"

namespace pelage {

/// The line of sight of a camera sample, in the frame of its tile. At depth z, its x and y are a + z * b.
struct TileLine {
  V2f a{0}, b{0};
  float time = 0;       ///< shutter time in [0, 1]
  uint32_t random = 0;  ///< Ray::random of the sample
};

/// The primitive that a line meets first.
struct TileWinner {
  static constexpr uint32_t kNothing = ~0u;     ///< value of `chunk`: the line meets nothing
  static constexpr uint32_t kTraced = ~0u - 1;  ///< value of `chunk`: drawing cannot decide; trace a ray

  uint32_t chunk = kNothing, primitive = 0;
};

}  // namespace pelage
