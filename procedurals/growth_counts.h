// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "procedurals/chunk_bounds.h"

namespace pelage {

/// Counts of the geometry that could be grown, and of the geometry that was grown for use.
struct GrowthCounts {
  int64_t chunks = 0;   ///< leaves of coats and skins that could be grown
  int64_t strands = 0;  ///< strands grown; strands that are grown again count again
  BoundsArea area;      ///< area of the boxes of all leaves of coats

  GrowthCounts& operator+=(const GrowthCounts& other) {
    chunks += other.chunks;
    strands += other.strands;
    area += other.area;
    return *this;
  }
};

}  // namespace pelage
