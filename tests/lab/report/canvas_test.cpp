// SPDX-License-Identifier: Apache-2.0
#include "lab/report/canvas.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

constexpr Canvas::Color kBlack = {0, 0, 0}, kRed = {255, 0, 0};

int reds(const Canvas& canvas) {
  int count = 0;
  const auto& pixels = canvas.picture().pixels;
  for (size_t i = 0; i < pixels.size(); i += 3) count += pixels[i] > 127;
  return count;
}

TEST(Canvas, CutsOffWhatIsOutside) {
  Canvas canvas(10, 6, kBlack);
  canvas.fill(-5, -5, 7, 7, kRed);
  EXPECT_EQ(reds(canvas), 4);
  canvas.draw(9, 5, {"", 2, 2, 1, {255, 255, 255, 255}});
  EXPECT_EQ(canvas.picture().pixels.size(), 10u * 6 * 3);
}

TEST(Canvas, LinesHaveTheirLengthWhereverTheyGo) {
  Canvas canvas(40, 40, kBlack);
  canvas.line(5, 20, 35, 20, kRed);
  EXPECT_NEAR(reds(canvas), 60, 8);  // 30 long, about two pixels wide
  Canvas point(8, 8, kBlack);
  point.line(4, 4, 4, 4, kRed);
  EXPECT_GT(reds(point), 0);
  point.line(NAN, 0, 1, 1, kRed);
  point.line(-1e9, -1e9, 1e9, 1e9, kRed);
}

}  // namespace
}  // namespace pelage
