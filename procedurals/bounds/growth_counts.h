// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "procedurals/bounds/chunk_bounds.h"

namespace pelage {

/// Counts of the chunks that rays could hit, and of the strands that were grown for rays. Strands that were
/// grown only to measure their boxes do not count.
struct GrowthCounts {
  int64_t chunks = 0;   ///< count of chunks of coats and skins, grown or not
  int64_t strands = 0;  ///< count of strands grown; a strand counts each time it is grown
  BoundsArea area;      ///< total area of the boxes of all chunks of coats

  GrowthCounts& operator+=(const GrowthCounts& other) {
    chunks += other.chunks;
    strands += other.strands;
    area += other.area;
    return *this;
  }
};

}  // namespace pelage
