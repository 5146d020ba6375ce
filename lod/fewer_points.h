// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "geom/strands.h"

namespace pelage {

/// Refits a strand with 5 or 4 control points if this moves no point of its curve by more than `tolerance` at
/// any motion key. `tolerance`: one value per strand, scene units; 0 leaves the strand unchanged. Least
/// squares with fixed ends; the error is measured at the parameters of the old curve. Radii are fitted like
/// the curve, per-point attributes with hat functions; both keep their mean along the strand. Strands in
/// other bases than the pinned B-spline are unchanged. The result for a strand depends on that strand only.
Strands with_fewer_points(Strands strands, std::span<const float> tolerance);

}  // namespace pelage
