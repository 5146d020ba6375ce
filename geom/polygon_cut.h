// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// Cuts a polygon into triangles. The polygon need be neither convex nor exactly planar. Appends three corner
/// indices per triangle to `triangles`, in the polygon's orientation; the first corner of the polygon has
/// index 0.
///
/// Clips ears until none is left, each time the ear with the shortest cut. An ear is a convex corner whose
/// triangle contains no other corner [Meisters75]. If corners remain but none of them is an ear, cuts the
/// remainder into a fan of triangles. Omits triangles with a repeated vertex.
///
/// `vertices` holds the vertex number of each corner, `corners` its position.
void cut_polygon(std::span<const uint32_t> vertices, std::span<const V3f> corners,
                 std::vector<uint32_t>& triangles);

}  // namespace pelage
