// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pelage {

/// Counts of shadow rays by how their outcome became known, for one thread, one frame or several frames.
/// Traced rays are in RayStatistics.
struct OcclusionCounts {
  int64_t candidates = 0;         ///< points on lights that were sampled as targets of shadow rays
  int64_t candidates_proved = 0;  ///< of these, left out because the skin blocks them for certain
  int64_t rays_proved = 0;        ///< rays that were not traced because the skin blocks them for certain

  /// Counts the candidates of one shading. Its shadow ray counts as proved if all candidates are.
  void add_candidates(int64_t proposed, int64_t proved) {
    candidates += proposed;
    candidates_proved += proved;
    rays_proved += proved == proposed ? 1 : 0;
  }
  OcclusionCounts& operator+=(const OcclusionCounts& other) {
    candidates += other.candidates;
    candidates_proved += other.candidates_proved;
    rays_proved += other.rays_proved;
    return *this;
  }
};

}  // namespace pelage
