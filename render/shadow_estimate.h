// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/job.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// Memory (in bytes) and CPU time (in seconds) of what a frame prepares to save shadow rays: skin
/// balls.
struct ShadowEstimate {
  int64_t making_bytes = 0;  ///< while balls are made, before the first ray
  int64_t held_bytes = 0;    ///< until the end of the frame
  double cpu_s = 0;
};

/// Makes the balls of a few skins, and computes the others from their sizes.
ShadowEstimate estimate_shadows(const RenderScene& scene, const Job& job);

}  // namespace pelage
