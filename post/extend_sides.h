// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "post/fill_holes.h"
#include "post/flow_field.h"
#include "post/warp.h"

namespace pelage {

/// Extends one row of a picture beyond each side where `cut` declares that the picture is cut off. The row of
/// the field is mirrored at this side. Each mirrored pixel keeps its depth and motion. If a sky moves farther
/// than a surface in front of it, mirrored sky appears behind this surface, as it would in a wider picture.
///
/// `line`: sample row `row` of the result, from column 0 on, after the warp to time 1. Each empty sample
/// becomes the nearest of the mirrored pixels that move to it, and is marked kExtended in `filled`. Samples
/// that no mirrored pixel reaches stay empty. `max`: max number of pixels to mirror at each side.
void extend_sides(const FlowField& field, const WarpTarget& target, RowEnds cut, int max, int row,
                  std::span<Sample> line, std::span<uint8_t> filled);

}  // namespace pelage
