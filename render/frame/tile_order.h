// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace pelage {

/// A square tile of the picture, in pixels; clipped at the right and lower border.
struct Tile {
  int x0 = 0, y0 = 0;
  int x1 = 0, y1 = 0;
};

/// All tiles of a picture, in the order of a Hilbert curve [Hilbert1891]: consecutive tiles are neighbours,
/// so fur that was grown for one tile is available for the next.
std::vector<Tile> tiles_along_curve(int width, int height, int side);

/// The same tiles, reordered so that consecutive ones are far apart, like van der Corput numbers [Corput35]:
/// threads that start together do not all wait for the same fur.
std::vector<Tile> scattered(const std::vector<Tile>& tiles);

}  // namespace pelage
