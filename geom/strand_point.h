// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"
#include "geom/strands.h"

namespace pelage {

/// The centre line of a strand at one place.
struct StrandPoint {
  V3f position{0};
  float radius = 0;
  V3f tangent{0};  ///< unit, root to tip
};

/// At parameter t of a segment and time [0, 1] of the shutter. The same curve as bezier_segment_at() gives,
/// straight from the strand's own points: for renderers, which ask for one place at a time.
StrandPoint strand_point(const Strands& strands, size_t strand, uint32_t segment, float t, float time);

/// Unit tangent at v in [0, 1] over the whole strand, all segments of equal parameter length.
V3f strand_tangent(const Strands& strands, size_t strand, float v, float time);

}  // namespace pelage
