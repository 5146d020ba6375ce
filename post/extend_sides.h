// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "post/fill_holes.h"
#include "post/flow_field.h"
#include "post/warp.h"

namespace pelage {

/// Extends a picture beyond its left and right sides, where `cut` declares that the picture is cut off. A row
/// of the field is mirrored at the side, and each mirrored pixel keeps its depth and motion. A sky that moves
/// farther than a surface in front of it therefore appears behind that surface, as it would in a wider
/// picture.
///
/// `line`: sample row `row` of the result from column 0 on, warped to time 1; empty samples get the nearest
/// of the mirrored pixels that reach them, and kExtended in `filled`. Extends by at most `max` pixels on each
/// side.
void extend_sides(const FlowField& field, const WarpTarget& target, RowEnds cut, int max, int row,
                  std::span<Sample> line, std::span<uint8_t> filled);

}  // namespace pelage
