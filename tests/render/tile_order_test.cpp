// SPDX-License-Identifier: Apache-2.0
#include "render/path/tile_order.h"

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(TileOrder, EveryPixelLiesInOneTile) {
  for (const auto& [width, height] : {std::pair(1, 1), {16, 16}, {17, 5}, {100, 333}, {640, 360}}) {
    std::vector<int> seen(static_cast<size_t>(width * height), 0);
    for (const Tile& tile : tiles_along_curve(width, height, 16)) {
      ASSERT_LT(tile.x0, tile.x1);
      ASSERT_LT(tile.y0, tile.y1);
      for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) ++seen[static_cast<size_t>(y * width + x)];
      }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), width * height) << width << " x " << height;
  }
}

TEST(TileOrder, TilesThatFollowEachOtherTouch) {
  const std::vector<Tile> tiles = tiles_along_curve(512, 512, 16);
  ASSERT_EQ(tiles.size(), 1024u);
  for (size_t i = 1; i < tiles.size(); ++i) {
    const int step = std::abs(tiles[i].x0 - tiles[i - 1].x0) + std::abs(tiles[i].y0 - tiles[i - 1].y0);
    ASSERT_EQ(step, 16) << i;
  }
}

}  // namespace
}  // namespace pelage
