// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/vector.h"
#include "geom/strands.h"

namespace pelage {

/// Control points of a pinned uniform cubic B-spline of `count` points that runs along strand `strand` at
/// even arc length: the spline passes through the strand at its joints.
std::vector<V3f> resample_strand(const Strands& strands, size_t strand, int count);

}  // namespace pelage
