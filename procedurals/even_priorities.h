// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "groom/groom.h"

namespace pelage {

/// Returns a priority in [0, 1) for each follicle of a groom whose own priorities are independent random
/// numbers (Groom::has_priority_order()): the radical inverse of the strand's rank along a curve through the
/// roots. Strands with priorities below any 2^-n are evenly spread: every 2^n-th along the curve. So each
/// clump keeps the same fraction of its strands. The curve is a Z curve within each face of the skin, and
/// passes the faces in their order; without a skin, it is a Z curve through space. The result depends on the
/// roots at rest and the ids of the strands only, not on leaves.
std::vector<float> even_priorities(const Groom& groom);

}  // namespace pelage
