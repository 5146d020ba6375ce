// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "geom/strands.h"
#include "geom/tessellation.h"

namespace pelage {

/// The furry bumpy ball that other renderers were measured on: an ellipsoid of radius about 1 with bumps,
/// short fur of 8 points per strand combed by smooth noise, drooping, frizzy and pulled into about 2,500
/// clumps. The radius shrinks with the number of strands so that coverage stays the same.
struct BumpyBall {
  Strands strands;
  SkinMesh skin;
};

/// `motion`: how far the ball travels along x over the shutter; 0 gives one motion key.
BumpyBall make_bumpy_ball(size_t strand_count, uint64_t seed = 1, float motion = 0);

}  // namespace pelage
