// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/process_usage.h"
#include "render/frame/occlusion_counts.h"
#include "render/frame/ray_meter.h"

namespace pelage {

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
