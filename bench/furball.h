// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "geom/strands.h"
#include "render/accel/accel.h"

namespace pelage {

/// The unit sphere with combed and curled strands, for comparing accelerators. Strands have 8 points, the
/// length 0.15, a bend of 0.8 times the length, and the curl radius 0.02. With 100,000 strands, they are
/// 0.0008 wide at the root and taper to a tenth. With more strands, they are thinner, so that coverage stays
/// the same.
Strands make_furball(size_t strand_count);

/// Rays from places spread evenly in the shell of height 0 to 0.12, over the outward half space.
std::vector<Ray> rays_deep_in_furball(size_t count);
/// Rays of a pinhole that the ball fills, row by row.
std::vector<Ray> camera_rays_at_furball(size_t pixels);

}  // namespace pelage
