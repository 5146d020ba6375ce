// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "image/exr.h"

namespace pelage {

/// A square of pixels, cut off at the right and lower border of the picture.
using Tile = PixelBox;

/// Returns all tiles of a picture, in the order of a Hilbert curve [Hilbert1891]. Consecutive tiles are close
/// together, so fur that was grown for one tile can be used for the next. `side`: side of a tile in pixels.
std::vector<Tile> tiles_along_curve(int width, int height, int side);

/// Returns the same tiles in the order of the van der Corput sequence [Corput35]. Consecutive tiles are far
/// apart, so threads that start together do not all wait for the same fur.
std::vector<Tile> scattered(const std::vector<Tile>& tiles);

}  // namespace pelage
