// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// Triangulates a polygon, which need not be convex or exactly planar: appends corner indices starting at 0,
/// three per triangle, in the polygon's orientation. Repeatedly clips the ear with the shortest cut. An ear
/// is a convex corner whose triangle contains no other corner [Meisters75]. A remainder without ears becomes
/// a fan. Triangles with a repeated vertex are omitted.
///
/// `vertices`: vertex numbers, `corners`: positions of the polygon's corners.
void cut_polygon(std::span<const uint32_t> vertices, std::span<const V3f> corners,
                 std::vector<uint32_t>& triangles);

}  // namespace pelage
