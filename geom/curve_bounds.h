// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"
#include "geom/curve.h"

namespace pelage {

/// Box of the Bezier hull of a segment, inflated by its largest radius: fast and, for fur, within 2 % of the
/// exact one (a hull of B-spline points is 7 to 9 times larger).
Box3f hull_bounds(const CubicSegment& segment);

/// Smallest box of the segment's ray-facing ribbon: exact extrema of the centre line per axis, where radius
/// varies the extrema of position +- radius.
Box3f exact_bounds(const CubicSegment& segment);

/// Exact box of a batch over the shutter [open, close] within [0, 1]: every point +- radius at every time
/// lies inside and some point touches each face (law 4). Points move linearly between motion keys, so the
/// union over the keys inside the shutter and its two ends is exact.
Box3f exact_bounds(const Strands& strands, float open = 0, float close = 1);

}  // namespace pelage
