// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// Cuts a polygon, which need not be convex or quite flat, into triangles with its vertices as corners:
/// appends corner numbers counted from 0, three for each triangle, in the polygon's sense of rotation.
/// The ear with the shortest cut goes first, as long as there is one: a corner that is convex and has no
/// other corner inside [Meisters75]; what is left without one becomes a fan. Triangles with a repeated vertex
/// are left out.
///
/// `vertices` are the numbers, `corners` the positions of the polygon's corners.
void cut_polygon(std::span<const uint32_t> vertices, std::span<const V3f> corners,
                 std::vector<uint32_t>& triangles);

}  // namespace pelage
