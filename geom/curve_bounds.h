// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"
#include "geom/curve.h"

namespace pelage {

// All boxes hold the curve's swept spheres, every point +- radius, which is where a ribbon can be that may
// face any ray. They are enlarged by 2^-21 of the largest coordinate, so that points evaluated in float lie
// inside too.

/// Box of the Bezier hull: per axis the reach of each Bezier point +- its radius. Fast and, for fur, within 2
/// % of the exact box (a hull of B-spline points is 7 to 9 times larger).
Box3f hull_bounds(const CubicSegment& segment);

/// The same of every segment of a strand at motion key `key`, appended in their order; at a fraction of the
/// cost of one by one.
void append_hull_bounds(const Strands& strands, size_t strand, int key, std::vector<Box3f>& boxes);

/// Smallest box of the swept spheres. Position + radius and position - radius along an axis are cubics of
/// their own, whose extrema are roots of quadratics.
Box3f exact_bounds(const CubicSegment& segment);

/// Smallest box of a batch over the shutter [open, close] within [0, 1] (law 4); empty for no segments.
/// Points and radii move linearly between motion keys, so the union over the keys inside the shutter and its
/// two ends is exact.
Box3f exact_bounds(const Strands& strands, float open = 0, float close = 1);
/// The same of some strands of the batch, by index.
Box3f exact_bounds(const Strands& strands, std::span<const uint32_t> some, float open = 0, float close = 1);

}  // namespace pelage
