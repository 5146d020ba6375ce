// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "geom/strands.h"
#include "render/accel/accel.h"

namespace pelage {

/// The unit sphere with combed and curled strands of 8 points that accelerators are compared on: length 0.15,
/// bent by 0.8 of it, curl radius 0.02; 0.0008 wide at 100,000 strands, tapering to a tenth; with more
/// strands thinner, so that they cover as much.
Strands make_furball(size_t strand_count);

/// Rays from places spread evenly in the shell of height 0 to 0.12, over the outward half space.
std::vector<Ray> rays_deep_in_furball(size_t count);
/// Rays of a pinhole that the ball fills, row by row.
std::vector<Ray> camera_rays_at_furball(size_t pixels);

}  // namespace pelage
