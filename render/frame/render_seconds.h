// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/frame/tile_costs.h"

namespace pelage {

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
