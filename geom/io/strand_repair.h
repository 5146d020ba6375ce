// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "geom/io/strand_file.h"

namespace pelage {

/// Repairs the arrays of a file (one motion key, no roots) in place, so that they are valid Strands. Returns
/// counts of the repairs.
/// - Drops a strand if one of its points is not finite or has a coordinate beyond 1e18, if it has fewer
///   points than its basis needs, or if it has no extent. The other strands keep their ids.
/// - Removes a point that is equal to the previous one, except with kBSpline, where repeated points have a
///   meaning.
/// - Replaces radii that are negative, NaN or beyond 1e18 by 0. A strand whose radii are then all 0 gets the
///   radius `default_width` / 2. In a file without widths, this applies to all strands.
/// - Replaces attribute values that are not finite by 0.
StrandRepairs repair_strands(StrandArrays& arrays, float default_width);

/// Returns the width to assume when neither the file nor the options state one: a thousandth of the longest
/// side of the box of all usable points.
float assumed_width(const StrandArrays& arrays);
float assumed_width(const Box3f& box);
/// Returns the box, for assumed_width(), of all points that are finite and have no coordinate beyond 1e18.
Box3f usable_box(const StrandArrays& arrays);

}  // namespace pelage
