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

/// Evaluates parameter t of a segment at shutter time [0, 1]. Gives the same curve as bezier_segment_at(),
/// but computes it directly from the strand's points, for renderers, which need one point at a time.
StrandPoint strand_point(const Strands& strands, size_t strand, uint32_t segment, float t, float time);

/// Unit tangent at v in [0, 1] over the whole strand, where all segments have equal parameter length.
V3f strand_tangent(const Strands& strands, size_t strand, float v, float time);

}  // namespace pelage
