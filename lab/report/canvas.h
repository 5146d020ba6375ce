// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "lab/report/report.h"

namespace pelage {

/// A picture to draw on: other pictures, lines, and words in small letters of pixels. sRGB, (0, 0) the upper
/// left corner; what is outside is cut off.
class Canvas {
 public:
  using Color = std::array<unsigned char, 3>;
  Canvas(int width, int height, Color ground);

  void fill(int x, int y, int width, int height, Color color);
  /// With its upper left corner at (x, y).
  void draw(int x, int y, const Picture& picture);
  /// About 1.5 pixels wide, with smooth edges.
  void line(double x0, double y0, double x1, double y1, Color color);
  /// Letters are 5 x 7 pixels times `size`, its upper left corner at (x, y). Characters beyond ASCII are
  /// shown as a box.
  void text(int x, int y, std::string_view text, Color color, int size = 2);
  static int text_width(std::string_view text, int size = 2);
  static int text_height(int size = 2) { return 7 * size; }

  const Picture& picture() const { return picture_; }

 private:
  void blend(int x, int y, Color color, double share);
  Picture picture_;
};

}  // namespace pelage
