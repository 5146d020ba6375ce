// SPDX-License-Identifier: Apache-2.0
#include "render/frame/tile_order.h"

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

TEST(TileOrder, ScatteredTilesAreTheSameOnesFarApart) {
  for (size_t count : {size_t(0), size_t(1), size_t(2), size_t(37), size_t(1024)}) {
    std::vector<Tile> tiles(count);
    for (size_t i = 0; i < count; ++i) tiles[i].x0 = static_cast<int>(i);
    const std::vector<Tile> apart = scattered(tiles);
    std::vector<int> places;
    for (const Tile& tile : apart) places.push_back(tile.x0);
    for (size_t i = 3; i < count && i < 16; ++i) {
      for (size_t j = i - 3; j < i; ++j)
        EXPECT_GE(std::abs(places[i] - places[j]), static_cast<int>(count / 8)) << i;
    }
    std::sort(places.begin(), places.end());
    for (size_t i = 0; i < count; ++i) EXPECT_EQ(places[i], static_cast<int>(i));
  }
}

}  // namespace
}  // namespace pelage
