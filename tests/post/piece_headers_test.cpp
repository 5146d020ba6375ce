// SPDX-License-Identifier: Apache-2.0
#include "post/piece_headers.h"

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

TEST(Uncovered, ContainsEachPixelThatNoBoxContainsOnce) {
  const PixelBox frame{-3, 2, 17, 19};
  for (uint64_t seed = 0; seed < 200; ++seed) {
    const auto number = [&](uint64_t i, int range) {
      return static_cast<int>(hash64(seed, i) % static_cast<uint64_t>(range));
    };
    std::vector<PixelBox> boxes;
    for (uint64_t i = 0; i < seed % 7; ++i) {
      const int x = number(4 * i, 24) - 5, y = number(4 * i + 1, 24);
      boxes.push_back({x, y, x + number(4 * i + 2, 12), y + number(4 * i + 3, 12)});
    }
    const std::vector<PixelBox> left = uncovered_boxes(frame, boxes);
    const auto holds = [](const PixelBox& box, int x, int y) {
      return x >= box.x0 && x < box.x1 && y >= box.y0 && y < box.y1;
    };
    for (int y = frame.y0 - 2; y < frame.y1 + 2; ++y) {
      for (int x = frame.x0 - 2; x < frame.x1 + 2; ++x) {
        int covered = 0, found = 0;
        for (const PixelBox& box : boxes) covered += holds(box, x, y);
        for (const PixelBox& box : left) found += holds(box, x, y);
        ASSERT_EQ(found, holds(frame, x, y) && covered == 0 ? 1 : 0) << seed << ": " << x << ", " << y;
      }
    }
  }
}

}  // namespace
}  // namespace pelage
