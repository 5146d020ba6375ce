// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "geom/strands.h"

namespace pelage {

/// Refits strands with 5 or 4 control points where that moves no point of the curve, at any motion key, by
/// more than `tolerance` of the strand (one per strand, scene units; 0 leaves it alone). Least squares with
/// both ends kept; error is measured at the parameters of the old curve. Radii are fitted as the curve is,
/// per-point attributes by hats, both so that their mean along the strand stays. Strands of other bases than
/// the pinned B-spline stay as they are. What becomes of a strand depends on nothing but the strand.
Strands with_fewer_points(Strands strands, std::span<const float> tolerance);

}  // namespace pelage
