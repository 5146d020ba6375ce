// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <utility>

#include "lab/report/report.h"

namespace pelage {

/// A picture to draw pictures, lines and labels on. sRGB, (0, 0) at the upper left corner; clips to its area.
class Canvas {
 public:
  using Color = std::array<unsigned char, 3>;
  Canvas(int width, int height, Color ground);

  void fill(int x, int y, int width, int height, Color color);
  /// Draws a picture with its upper left corner at (x, y).
  void draw(int x, int y, const Picture& picture);
  /// Draws an antialiased line, about 1.5 pixels wide.
  void line(double x0, double y0, double x1, double y1, Color color);
  /// Adds text over the picture, for pages and SVG files.
  void label(Label label) { picture_.labels.push_back(std::move(label)); }

  const Picture& picture() const { return picture_; }

 private:
  void blend(int x, int y, Color color, double share);
  Picture picture_;
};

}  // namespace pelage
