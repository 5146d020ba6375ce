// SPDX-License-Identifier: Apache-2.0
#include "render/frame/tile_pass.h"

#include <atomic>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

TEST(TilePass, TracesEachTileOnce) {
  const std::vector<Tile> tiles = tiles_along_curve(100, 70, 16);
  QuietJob job(3);
  const Stopwatch clock;
  std::vector<std::atomic<int>> traced(7 * 5);
  const PassEnd end = trace_tiles(tiles, job, clock, kNever, [&](const Tile& tile, int worker) {
    EXPECT_LT(worker, 3);
    ++traced[static_cast<size_t>(tile.y0 / 16 * 7 + tile.x0 / 16)];
    return true;
  });
  EXPECT_EQ(end, PassEnd::kDone);
  for (const auto& times : traced) EXPECT_EQ(times, 1);
}

TEST(TilePass, EndsWhereATileIsCancelledOrTheTimeIsOver) {
  const std::vector<Tile> tiles = tiles_along_curve(100, 70, 16);
  QuietJob job(1);
  const Stopwatch clock;
  int traced = 0;
  EXPECT_EQ(trace_tiles(tiles, job, clock, kNever, [&](const Tile&, int) { return ++traced < 5; }),
            PassEnd::kCancelled);
  EXPECT_EQ(traced, 5);
  EXPECT_EQ(trace_tiles(tiles, job, clock, -1, [&](const Tile&, int) { return ++traced > 0; }),
            PassEnd::kOutOfTime);
  EXPECT_EQ(traced, 5);
}

}  // namespace
}  // namespace pelage
