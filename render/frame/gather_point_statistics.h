// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pelage {

/// Counts of `integrator: gather`, for one thread, one frame or several frames. A gather point is a position
/// on a strand or skin near which camera samples share light. It counts once per tile that sees it, and once
/// per pass over that tile. In a long frame, the first pass has one sample per pixel.
struct GatherPointStatistics {
  /// `samples`: camera samples that hit a strand or skin.
  int64_t gather_points = 0, samples = 0;

  GatherPointStatistics& operator+=(const GatherPointStatistics& other) {
    gather_points += other.gather_points;
    samples += other.samples;
    return *this;
  }
};

}  // namespace pelage
