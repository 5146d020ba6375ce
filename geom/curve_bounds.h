// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"
#include "geom/curve.h"

namespace pelage {

// Every box contains the swept spheres of the curve: the spheres around all points of the curve, with the
// radius at that point. The box therefore contains the ribbons for rays of any direction. It is enlarged by
// 2^-21 of its largest coordinate, so that points of the curve that are evaluated in float lie inside.

/// Returns the box of the Bezier hull: on each axis, the range of the control points minus and plus their
/// radii. Fast. For fur, this box is at most 2 % larger than the exact box. The hull of B-spline points would
/// be 7 to 9 times larger.
Box3f hull_bounds(const CubicSegment& segment);

/// Appends hull_bounds() of every segment of a strand at motion key `key`, from root to tip. Much cheaper
/// than one call of hull_bounds() per segment.
void append_hull_bounds(const Strands& strands, size_t strand, int key, std::vector<Box3f>& boxes);

/// Returns the smallest box of the swept spheres. On each axis, position + radius and position - radius are
/// cubics in the parameter. Their extrema are found as roots of quadratics.
Box3f exact_bounds(const CubicSegment& segment);

/// Returns the smallest box that contains all strands of a batch during the shutter interval [open, close]
/// within [0, 1] (law 4). The box is empty if the batch has no segments. Points and radii move linearly
/// between motion keys. The union of the boxes at `open`, at `close` and at the motion keys in between is
/// therefore exact.
Box3f exact_bounds(const Strands& strands, float open = 0, float close = 1);
/// Returns the box of only those strands of the batch whose indices are in `some`.
Box3f exact_bounds(const Strands& strands, std::span<const uint32_t> some, float open = 0, float close = 1);

}  // namespace pelage
