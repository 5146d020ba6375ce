// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/strands.h"
#include "rib/syntax/rib_basis.h"
#include "rib/syntax/rib_parameters.h"

namespace pelage {

/// Numbers of points, segments and values of the curves of one request.
struct RibCurveLayout {
  bool cubic = false, periodic = false;
  /// Whether a cubic curve reaches its first and last points, as if it had the phantom points of CurveBasis.
  bool pinned = false;
  RibBasis basis;
  std::vector<uint32_t> points;    ///< points per curve
  std::vector<uint32_t> segments;  ///< segments per curve; 0 if its points do not form whole segments
  size_t total_points = 0, total_joints = 0;
  size_t unusable = 0;        ///< curves without segments
  uint32_t stray_joints = 0;  ///< values per joint of an unusable cubic curve, see fit_stray_joints()

  /// Number of values per joint of a curve: a periodic curve ends where it begins.
  uint32_t joints(size_t curve) const {
    if (segments[curve] > 0) return segments[curve] + (periodic ? 0 : 1);
    return cubic ? stray_joints : points[curve];
  }
  /// Number of values that a parameter of this class must have.
  size_t values(RibClass frequency) const;
  /// Sets `stray_joints` so that parameters per joint may have `values` values. Programs disagree about the
  /// joints of a cubic curve that is too short. Without a fitting number, nothing changes.
  void fit_stray_joints(size_t values);
};

/// Reads the first three arguments of Curves. Curves with too few points are kept with no segments. Throws
/// Error (kInput).
RibCurveLayout read_curve_layout(const RibStatement& request, const RibBasis& basis);

inline constexpr uint32_t kRibSubdivision = 4;  ///< B-spline segments per segment of a resampled curve

/// Appends new points for `curve`, whose points are `p` (x, y, z), to `out`: for each strand, those of a
/// B-spline without phantom points. `first`: the segments with which strands begin.
void resample_curve(const RibCurveLayout& layout, size_t curve, std::span<const float> p,
                    std::span<const uint32_t> first, std::vector<float>& out);
/// Returns the segments of a curve that do not begin where their predecessor ends, and 0.
std::vector<uint32_t> strand_starts(const RibCurveLayout& layout, size_t curve, std::span<const float> p);

}  // namespace pelage
