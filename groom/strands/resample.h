// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/vector.h"
#include "geom/strands.h"

namespace pelage {

/// Returns the control points of a pinned uniform cubic B-spline with `count` points. The knots of this
/// spline lie on strand `strand`, at equal distances of arc length.
std::vector<V3f> resample_strand(const Strands& strands, size_t strand, int count);

}  // namespace pelage
