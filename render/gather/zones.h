// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace pelage {

/// A coat has this many zones: ranges of depth of equal length, from the roots to the tips of its strands. A
/// skin uses only the first of its zones.
inline constexpr uint32_t kZonesOfCoat = 8;

/// A tile keeps statistics for this many zones, which are those of 32 coats and skins. If it has more, zones
/// whose indices are equal modulo this number share their statistics.
inline constexpr size_t kZonesOfTile = 32 * kZonesOfCoat;

/// A position along the strands of a coat, between the middles of two of its zones.
struct DepthPlace {
  uint32_t zone = 0;      ///< index in the tile of the zone nearer to the roots; not the last of its coat
  float toward_next = 0;  ///< 0 in the middle of `zone`, 1 in the middle of zone + 1; in [-0.5, 1.5]
};

}  // namespace pelage
