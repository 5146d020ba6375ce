// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace pelage {

/// How far the guides of a coat are turned away from their groomed shape at one time: a unit quaternion
/// (x, y, z, w) with w >= 0, along the axes of world space, for each segment of each guide. All segments of
/// guide 0 come first.
using GuideTurns = std::vector<float>;

/// Interpolates linearly between turns, segment by segment: `a` at t = 0, `b` at t = 1. The quaternions of
/// the result are not normalised.
GuideTurns blend_turns(GuideTurns a, const GuideTurns& b, float t);

}  // namespace pelage
