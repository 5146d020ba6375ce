// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "post/fill_holes.h"
#include "post/flow_field.h"
#include "post/warp.h"

namespace pelage {

/// Continues a picture beyond its left and right sides, where `cut` says that it is cut off: a row of the
/// field is mirrored at the side, and each mirrored pixel keeps its depth and its motion. So a sky that moves
/// further than what is before it appears behind it, as it would if the picture were wider.
///
/// `line` is sample row `row` of the result from its column 0 on, warped to time 1; samples that are empty
/// get what is mirrored, the nearest where several meet, and kExtended in `filled`. At most `max` pixels
/// beyond each side are made.
void extend_sides(const FlowField& field, const WarpTarget& target, RowEnds cut, int max, int row,
                  std::span<Sample> line, std::span<uint8_t> filled);

}  // namespace pelage
