// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/vector.h"
#include "geom/strands.h"

namespace pelage {

/// Control points of a pinned uniform cubic B-spline with `count` points. The knots of the spline lie on
/// strand `strand`, at even arc length.
std::vector<V3f> resample_strand(const Strands& strands, size_t strand, int count);

}  // namespace pelage
