// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"
#include "geom/strands.h"

namespace pelage {

/// The centre line of a strand at one point.
struct StrandPoint {
  V3f position{0};
  float radius = 0;
  V3f tangent{0};  ///< unit, root to tip
};

/// Returns the point at parameter t of a segment, at shutter time `time` in [0, 1]. It lies on the curve that
/// bezier_segment_at() returns, but is evaluated directly from the strand's points. This is faster for
/// renderers, which need one point at a time.
StrandPoint strand_point(const Strands& strands, size_t strand, uint32_t segment, float t, float time);

/// Returns the unit tangent at position v of the strand, where v goes from 0 at the root to 1 at the tip with
/// the same range for every segment.
V3f strand_tangent(const Strands& strands, size_t strand, float v, float time);

}  // namespace pelage
