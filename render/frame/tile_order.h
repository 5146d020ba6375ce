// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace pelage {

/// A square piece of the picture, in pixels; cut off at the right and lower border.
struct Tile {
  int x0 = 0, y0 = 0;
  int x1 = 0, y1 = 0;
};

/// All tiles of a picture, in the order of a Hilbert curve [Hilbert1891]: tiles that follow each other are
/// neighbours, so that what one of them made the fur grow for is there for the next.
std::vector<Tile> tiles_along_curve(int width, int height, int side);

/// The same tiles so that those which follow each other lie far apart, like the numbers of van der Corput
/// [Corput35]: threads that begin together do not all wait for the same fur to grow.
std::vector<Tile> scattered(const std::vector<Tile>& tiles);

}  // namespace pelage
