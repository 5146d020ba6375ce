// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "base/vector.h"
#include "geom/strands.h"

namespace pelage {

/// One cubic span in Bezier form, with radii beside positions.
struct CubicSegment {
  std::array<V3f, 4> p;
  std::array<float, 4> r;
};

/// Segment `segment` of a strand at motion key `key`, with phantom ends where the basis has them. Linear
/// segments become cubics with evenly spaced control points.
CubicSegment bezier_segment(const Strands& strands, size_t strand, uint32_t segment, int key = 0);
/// The same at shutter time `time` in [0, 1]: points interpolated linearly between keys.
CubicSegment bezier_segment_at(const Strands& strands, size_t strand, uint32_t segment, float time);

V3f curve_position(const CubicSegment& segment, float t);
/// Derivative with respect to t, not normalised. Where the derivative vanishes, returns the direction at the
/// nearest point with a derivative (+y for a segment that is a single point).
V3f curve_tangent(const CubicSegment& segment, float t);
/// Never negative: a Catmull-Rom radius that overshoots below 0 counts as 0.
float curve_radius(const CubicSegment& segment, float t);

/// The segment that contains v in [0, 1] of the whole strand at shutter time `time`, where all segments have
/// equal parameter length; `t` becomes the parameter within it. The strand must have at least one segment.
CubicSegment segment_at(const Strands& strands, size_t strand, float v, float time, float& t);

}  // namespace pelage
