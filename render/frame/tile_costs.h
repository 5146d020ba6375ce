// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/process_usage.h"
#include "render/frame/ray_meter.h"

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

/// Cost of tracing tiles, of one thread or summed over threads.
struct TileCosts {
  RayMeter rays;
  OcclusionCounts occlusion;
  double cpu_s = 0;  ///< CPU seconds, including the rays and the growth of chunks

  TileCosts& operator+=(const TileCosts& other) {
    rays += other.rays;
    occlusion += other.occlusion;
    cpu_s += other.cpu_s;
    return *this;
  }
};

/// Adds the CPU time of the calling thread during its scope to the costs of a tile.
class TileTimer {
 public:
  explicit TileTimer(TileCosts& costs) : costs_(costs), began_s_(thread_cpu_seconds()) { costs.rays.begin(); }
  ~TileTimer() { costs_.cpu_s += thread_cpu_seconds() - began_s_; }
  TileTimer(const TileTimer&) = delete;
  TileTimer& operator=(const TileTimer&) = delete;

 private:
  TileCosts& costs_;
  double began_s_;
};

}  // namespace pelage
