// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/process_usage.h"
#include "render/frame/ray_meter.h"

namespace pelage {

/// What tracing tiles took: of one thread, or summed over threads.
struct TileCosts {
  RayMeter rays;
  double cpu_s = 0;

  TileCosts& operator+=(const TileCosts& other) {
    rays += other.rays;
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

/// CPU seconds of tracing the tiles of a frame, without the growth of chunks; over all threads.
struct RenderSeconds {
  double camera_rays = 0, shadow_rays = 0, indirect_rays = 0;
  double shading = 0;  ///< everything else: materials, choice of lights, film

  double total() const { return camera_rays + shadow_rays + indirect_rays + shading; }
  RenderSeconds& operator+=(const RenderSeconds& other);
};

/// Divides the CPU time of tiles, of which `growth_s` was spent on chunks. The times of rays are estimates:
/// if they exceed the rest, they are scaled down to it, so that the sum is always the CPU time less
/// `growth_s`.
RenderSeconds render_seconds(const TileCosts& tiles, double growth_s);

}  // namespace pelage
