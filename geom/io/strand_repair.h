// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "geom/io/strand_file.h"

namespace pelage {

/// Repairs raw arrays of a file (one motion key, no roots) in place, so that they are valid Strands:
/// - strands with a point that is not finite or farther than 1e18 from the origin, with fewer points than
/// their basis needs, or without extent are dropped; the ids of the others stay;
/// - points equal to the previous one are removed, except where the basis gives them a meaning (kBSpline);
/// - negative and NaN radii become 0; strands without any width get the radius `default_width` / 2. In a file
///   without widths, these are all strands.
/// Non-finite attribute values become 0.
StrandRepairs repair_strands(StrandArrays& arrays, float default_width);

/// Assumed width when neither the file nor the reader states one: a thousandth of the largest side of the box
/// of all points.
float assumed_width(const StrandArrays& arrays);
float assumed_width(const Box3f& box);
/// Box of all points that are finite and not absurdly far away, for assumed_width().
Box3f usable_box(const StrandArrays& arrays);

}  // namespace pelage
