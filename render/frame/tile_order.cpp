// SPDX-License-Identifier: Apache-2.0
#include "render/frame/tile_order.h"

#include <algorithm>
#include <bit>

namespace pelage {
namespace {

struct Cell {
  uint32_t x = 0, y = 0;
};

/// Cell number `index` of the Hilbert curve through a square of `side` (a power of two) cells. Two bits of
/// the index select a quadrant per level, from the smallest; the first and the last quadrant are rotated.
Cell hilbert_cell(uint64_t index, uint32_t side) {
  Cell cell;
  for (uint32_t size = 1; size < side; size *= 2, index /= 4) {
    const bool right = (index & 2) != 0;
    const bool up = right != ((index & 1) != 0);
    if (!up) {
      if (right) cell = {size - 1 - cell.x, size - 1 - cell.y};
      std::swap(cell.x, cell.y);
    }
    cell.x += right ? size : 0;
    cell.y += up ? size : 0;
  }
  return cell;
}

}  // namespace

std::vector<Tile> tiles_along_curve(int width, int height, int side) {
  const auto columns = static_cast<uint32_t>((width + side - 1) / side);
  const auto rows = static_cast<uint32_t>((height + side - 1) / side);
  const uint32_t square = std::bit_ceil(std::max(columns, rows));
  std::vector<Tile> tiles;
  tiles.reserve(static_cast<size_t>(columns) * rows);
  for (uint64_t i = 0; i < uint64_t(square) * square; ++i) {
    const Cell cell = hilbert_cell(i, square);
    if (cell.x >= columns || cell.y >= rows) continue;
    const int x0 = static_cast<int>(cell.x) * side, y0 = static_cast<int>(cell.y) * side;
    tiles.push_back({x0, y0, std::min(x0 + side, width), std::min(y0 + side, height)});
  }
  return tiles;
}

std::vector<Tile> scattered(const std::vector<Tile>& tiles) {
  std::vector<Tile> result;
  result.reserve(tiles.size());
  const int bits = std::bit_width(std::bit_ceil(tiles.size())) - 1;
  for (size_t i = 0; i < size_t(1) << bits; ++i) {
    size_t reversed = 0;
    for (int bit = 0; bit < bits; ++bit) reversed |= (i >> bit & 1) << (bits - 1 - bit);
    if (reversed < tiles.size()) result.push_back(tiles[reversed]);
  }
  return result;
}

}  // namespace pelage
