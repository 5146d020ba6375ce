// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "geom/strands.h"

namespace pelage {

/// Refits each strand with 4 control points or, if that moves the curve too far, with 5. Uses the fit only if
/// it moves no point of the curve by more than the strand's `tolerance` at any motion key; otherwise leaves
/// the strand unchanged. `tolerance`: one value per strand, in scene units; 0 leaves the strand unchanged.
///
/// The fit is by least squares with fixed ends. The error is the distance between points of the old and the
/// new curve at equal parameters. Radii are fitted like positions. Per-point attributes are fitted as values
/// that are linear between points, and then limited to their old range around their mean. The means of radii
/// and attributes along the strand stay nearly the same. Strands whose basis is not the pinned B-spline stay
/// unchanged. The result for a strand depends only on this strand and its tolerance.
Strands with_fewer_points(Strands strands, std::span<const float> tolerance);

}  // namespace pelage
