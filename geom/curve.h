// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "base/vector.h"
#include "geom/strands.h"

namespace pelage {

/// One cubic span in Bezier form, radius beside position.
struct CubicSegment {
  std::array<V3f, 4> p;
  std::array<float, 4> r;
};

/// Segment `segment` of a strand, phantom ends included, at motion key `key`. Linear segments come out as
/// cubics with evenly spaced points.
CubicSegment bezier_segment(const Strands& strands, size_t strand, uint32_t segment, int key = 0);
/// The same at shutter time `time` in [0, 1]: points interpolated linearly between keys.
CubicSegment bezier_segment_at(const Strands& strands, size_t strand, uint32_t segment, float time);

V3f curve_position(const CubicSegment& segment, float t);
/// Derivative with respect to t; where it vanishes, the direction of the nearest part that has one (+y for a
/// segment that is a single point). Not normalised.
V3f curve_tangent(const CubicSegment& segment, float t);
/// Never negative: where a Catmull-Rom radius overshoots below 0 it counts as 0.
float curve_radius(const CubicSegment& segment, float t);

/// The segment that holds v in [0, 1] of the whole strand, all segments being of equal parameter length, at
/// shutter time `time`; `t` becomes the parameter within it. The strand has at least one segment.
CubicSegment segment_at(const Strands& strands, size_t strand, float v, float time, float& t);

}  // namespace pelage
