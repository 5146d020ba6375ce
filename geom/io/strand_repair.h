// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "geom/io/strand_file.h"

namespace pelage {

/// Makes raw arrays of a file (one motion key, no roots) fit to be Strands, in place:
/// - strands with a point that is not finite or farther than 1e18 from the origin, with fewer points than
/// their basis
///   needs, or without extent are dropped; the ids of the others stay;
/// - points equal to the one before are removed, except where the basis gives them a meaning (kBSpline);
/// - radii that are negative or no numbers become 0; strands without any width, and all strands when
/// `default_width` is
///   for a file without widths, get half of `default_width`.
/// Values of attributes that are not finite become 0.
StrandRepairs repair_strands(StrandArrays& arrays, float default_width);

/// What a width is taken for where neither the file nor the reader says: a thousandth of the largest side of
/// the box of all points.
float assumed_width(const StrandArrays& arrays);
float assumed_width(const Box3f& box);
/// Of the points that is made of: those that are finite and not absurdly far away.
Box3f usable_box(const StrandArrays& arrays);

}  // namespace pelage
