// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "geom/strands.h"

namespace pelage {

/// Refits strands with 5 or 4 control points where this moves no point of the curve, at any motion key, by
/// more than the strand's `tolerance` (one per strand, scene units; 0 leaves it unchanged). Least squares
/// with fixed ends; the error is measured at the parameters of the old curve. Radii are fitted like the
/// curve, per-point attributes with hat functions; both keep their mean along the strand. Strands in other
/// bases than the pinned B-spline are unchanged. The result for a strand depends on that strand only.
Strands with_fewer_points(Strands strands, std::span<const float> tolerance);

}  // namespace pelage
