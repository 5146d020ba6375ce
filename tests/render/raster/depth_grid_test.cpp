// SPDX-License-Identifier: Apache-2.0
#include "render/raster/depth_grid.h"

#include <gtest/gtest.h>

#include "render/raster/tile_projection.h"
#include "tests/render/random.h"

namespace pelage {
namespace {

/// Lines through a lens of this radius, or a pinhole, that pass a square in focus at depth 10.
TileLines some_lines(TestRandom& random, float lens) {
  std::vector<TileLine> lines(600);
  for (TileLine& line : lines) {
    line.a = lens * V2f(random.between(-1, 1), random.between(-1, 1));
    line.b = 0.1f * V2f(random.between(-1, 1), random.between(-1, 1)) - 0.1f * line.a;
  }
  TileLines sorted;
  sorted.assign(lines, 10);
  return sorted;
}

V3f point_of(const TileLines::Arrays& lines, size_t line, float depth) {
  return {lines.ax[line] + depth * lines.bx[line], lines.ay[line] + depth * lines.by[line], depth};
}

TEST(DepthGrid, AFootprintHasTheCellsOfAllLinesThatMeetTheHull) {
  TestRandom random(3);
  for (const float lens : {0.0f, 0.5f}) {
    TileLines lines = some_lines(random, lens);
    const TileLines::Arrays arrays = lines.arrays();
    const TileProjection projection(lines, {0, 0});
    int partial = 0;
    for (int i = 0; i < 3000; ++i) {
      const auto line = static_cast<size_t>(random.between(0, 599.9f));
      const V3f met = point_of(arrays, line, random.between(0.01f, 20));
      // A triangle around this point, some parts of which may be behind the camera.
      const V3f a = random.between(0.01f, 1) * random.direction(),
                b = random.between(0.01f, 1) * random.direction();
      const V3f triangle[3] = {met + a, met + b, met - a - b};
      const ViewFootprint footprint = projection.find(triangle);
      EXPECT_TRUE(lines.grid().contains(footprint, line)) << lens << ' ' << met;
      EXPECT_LE(footprint.depth, met.z);
      partial += footprint.last[0] - footprint.first[0] + 1 < lines.grid().side() ? 1 : 0;
    }
    EXPECT_GT(partial, 1000);
  }
}

TEST(DepthGrid, HidesWhatIsBehindAllLinesOfItsCells) {
  TestRandom random(4);
  TileLines lines = some_lines(random, 0);
  const TileLines::Arrays arrays = lines.arrays();
  for (size_t i = 0; i < lines.size(); ++i) arrays.depth[i] = random.between(5, 10) + (i < 300 ? 0 : 5.0f);
  lines.update_grid();
  const DepthGrid& grid = lines.grid();
  const auto cell = [&] {
    return static_cast<uint8_t>(random.between(0, static_cast<float>(grid.side()) - 0.1f));
  };
  int hidden = 0;
  for (int i = 0; i < 2000; ++i) {
    const uint8_t x = cell(), y = cell();
    const ViewFootprint footprint{random.between(4, 16), {x, y}, {std::max(x, cell()), std::max(y, cell())}};
    bool behind = true;
    for (size_t line = 0; line < lines.size(); ++line)
      behind = behind && !(grid.contains(footprint, line) && footprint.depth < arrays.depth[line]);
    EXPECT_TRUE(behind || !grid.hides(footprint));
    hidden += grid.hides(footprint) ? 1 : 0;
  }
  EXPECT_GT(hidden, 100);
  EXPECT_LT(hidden, 1900);
}

TEST(DepthGrid, TracesLinesThatDoNotEndBeforeAFootprint) {
  TestRandom random(5);
  TileLines lines = some_lines(random, 0);
  const TileLines::Arrays arrays = lines.arrays();
  for (size_t i = 0; i < lines.size(); ++i) arrays.depth[i] = random.between(5, 10);
  const ViewFootprint footprint{7, {0, 0}, {2, 3}};
  const std::vector<float> before(arrays.depth, arrays.depth + lines.size());
  lines.trace(footprint);
  for (size_t i = 0; i < lines.size(); ++i) {
    const bool traced = before[i] >= 7 && lines.grid().contains(footprint, i);
    EXPECT_EQ(arrays.chunk[i] == TileWinner::kTraced, traced);
    EXPECT_EQ(arrays.depth[i], traced ? 7 : before[i]);
  }
}

}  // namespace
}  // namespace pelage
