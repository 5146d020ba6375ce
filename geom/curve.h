// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "base/vector.h"
#include "geom/strands.h"

namespace pelage {

/// One cubic segment of a strand in Bezier form: four control points, each with a radius.
struct CubicSegment {
  std::array<V3f, 4> p;
  std::array<float, 4> r;
};

/// Returns segment `segment` of a strand at motion key `key`. Adds phantom points at the ends of the strand
/// if its basis has them (CurveBasis). A linear segment becomes a cubic with evenly spaced control points.
CubicSegment bezier_segment(const Strands& strands, size_t strand, uint32_t segment, int key = 0);
/// Returns the segment at shutter time `time` in [0, 1]. Interpolates points and radii linearly between
/// motion keys.
CubicSegment bezier_segment_at(const Strands& strands, size_t strand, uint32_t segment, float time);

/// Returns the position at parameter t in [0, 1].
V3f curve_position(const CubicSegment& segment, float t);
/// Returns the derivative of the position with respect to t, not normalised. Where this derivative vanishes,
/// returns the direction of the curve near t instead, with an arbitrary length. For a segment that is a
/// single point, returns +y.
V3f curve_tangent(const CubicSegment& segment, float t);
/// Returns the radius at parameter t, never negative: an interpolated radius below 0 (an overshoot of
/// Catmull-Rom) becomes 0.
float curve_radius(const CubicSegment& segment, float t);

/// Returns the segment at position `v` of a strand, at shutter time `time`. `v` goes from 0 at the root to 1
/// at the tip, with the same range for every segment. Sets `t` to the parameter within the returned segment.
/// The strand must have at least one segment.
CubicSegment segment_at(const Strands& strands, size_t strand, float v, float time, float& t);

}  // namespace pelage
