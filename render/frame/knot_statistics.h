// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pelage {

/// Knots of `integrator: gather`, and the camera samples that share them; of one thread, of a frame or of a
/// run. A knot is counted once for each time that the samples of a tile are traced. The first pass, whose
/// samples are replaced, does not count.
struct KnotStatistics {
  int64_t knots = 0, samples = 0;

  KnotStatistics& operator+=(const KnotStatistics& other) {
    knots += other.knots;
    samples += other.samples;
    return *this;
  }
};

}  // namespace pelage
