// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pelage {

/// Counts of traced rays, by kind, for one thread, one frame or several frames.
struct RayStatistics {
  int64_t camera = 0, shadow = 0, indirect = 0;

  int64_t total() const { return camera + shadow + indirect; }
  RayStatistics& operator+=(const RayStatistics& other) {
    camera += other.camera;
    shadow += other.shadow;
    indirect += other.indirect;
    return *this;
  }
};

}  // namespace pelage
