// SPDX-License-Identifier: Apache-2.0
#include "lab/report/canvas.h"

#include <gtest/gtest.h>

#include "lab/report/pixel_font.h"

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
  canvas.text(-3, -2, "pelage", kRed);
  canvas.text(8, 5, "pelage", kRed, 3);
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

/// No two characters look the same, none is empty but the space, and text is as wide as it says.
TEST(PixelFont, TellsCharactersApart) {
  for (char a = ' '; a <= '~'; ++a) {
    EXPECT_EQ(pixel_glyph(a) == Glyph{}, a == ' ') << a;
    for (char b = static_cast<char>(a + 1); b <= '~'; ++b)
      EXPECT_NE(pixel_glyph(a), pixel_glyph(b)) << a << b;
  }
  EXPECT_EQ(pixel_glyph('\xe4'), pixel_glyph('\n'));
  EXPECT_EQ(Canvas::text_width("abc", 2), 34);
  EXPECT_EQ(Canvas::text_width("", 2), 0);
}

}  // namespace
}  // namespace pelage
