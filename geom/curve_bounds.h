// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"
#include "geom/curve.h"

namespace pelage {

// All boxes contain the swept spheres of the curve: every point +- radius. They therefore contain the ribbons
// that face any ray. They are enlarged by 2^-21 of the largest coordinate, so that points evaluated in float
// lie inside.

/// Box of the Bezier hull: on each axis, the extent of the Bezier points +- their radii. Fast, and for fur
/// within 2 % of the exact box (the hull of B-spline points is 7 to 9 times larger).
Box3f hull_bounds(const CubicSegment& segment);

/// Appends hull_bounds() of every segment of a strand at motion key `key`, in order. Much cheaper than one
/// call per segment.
void append_hull_bounds(const Strands& strands, size_t strand, int key, std::vector<Box3f>& boxes);

/// Smallest box of the swept spheres. On each axis, position + radius and position - radius are cubics; their
/// extrema are roots of quadratics.
Box3f exact_bounds(const CubicSegment& segment);

/// Smallest box of a batch over the shutter [open, close] within [0, 1] (law 4); empty for no segments.
/// Points and radii move linearly between motion keys, so the union over the keys inside the shutter and its
/// two ends is exact.
Box3f exact_bounds(const Strands& strands, float open = 0, float close = 1);
/// The same for some strands of the batch, given by index.
Box3f exact_bounds(const Strands& strands, std::span<const uint32_t> some, float open = 0, float close = 1);

}  // namespace pelage
