// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>

#include "geom/strands.h"
#include "lod/point_fit.h"

namespace pelage {

/// Refits strands with fewer points. Keeps the fits that it has prepared, because preparing one takes as long
/// as fitting hundreds of strands. Thread safety: one thread at a time.
class FewerPoints {
 public:
  /// Refits each strand with 4 control points or, if that moves the curve too far, with 5. Uses the fit only
  /// if it moves no point of the curve by more than the strand's `tolerance` at any motion key; otherwise
  /// leaves the strand unchanged. `tolerance`: one value per strand, in scene units; 0 leaves the strand
  /// unchanged.
  ///
  /// The fit is by least squares with fixed ends. The error is the distance between points of the old and the
  /// new curve at equal parameters. Radii are fitted like positions. Per-point attributes are fitted as
  /// values that are linear between points, and then limited to their old range around their mean. The means
  /// of radii and attributes along the strand stay nearly the same. Strands whose basis is not the pinned
  /// B-spline stay unchanged. The result for a strand depends only on this strand and its tolerance.
  Strands refit(Strands strands, std::span<const float> tolerance);

 private:
  /// The fit for a strand, or null if the strand stays unchanged.
  const PointFit* choose(const Strands& strands, size_t strand, float tolerance);

  std::map<std::pair<uint32_t, uint32_t>, PointFit> fits_;  // by the numbers of points before and after
};

/// FewerPoints::refit() of a single batch.
Strands with_fewer_points(Strands strands, std::span<const float> tolerance);

}  // namespace pelage
