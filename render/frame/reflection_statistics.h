// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace pelage {

/// Counts of the reflection cache of `integrator: gather`, for one thread, one frame or several frames.
struct ReflectionStatistics {
  int64_t cells = 0;  ///< of all sizes
  int64_t paths = 0;  ///< that found a second surface and were added to the cells
  /// Slices of cells that were filled one after the other, in the frame with most; 1 if memory suffices.
  int64_t slices = 0;
  int64_t bytes = 0;    ///< of the cells while the picture is rendered, in the frame with most
  int64_t lookups = 0;  ///< paths that asked for the light of their second surface
  int64_t found = 0;    ///< lookups that were answered; the other paths continued

  ReflectionStatistics& operator+=(const ReflectionStatistics& other) {
    cells += other.cells;
    paths += other.paths;
    slices = std::max(slices, other.slices);
    bytes = std::max(bytes, other.bytes);
    lookups += other.lookups;
    found += other.found;
    return *this;
  }
};

}  // namespace pelage
