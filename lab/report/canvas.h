// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "lab/report/report.h"

namespace pelage {

/// Returns the approximate width in pixels of a text in browsers, for layout. `size`: of the font.
double text_width(std::string_view text, double size);

/// An sRGB picture on which pictures, lines and labels can be drawn. (0, 0) is the upper left corner. Drawing
/// is clipped to the picture.
class Canvas {
 public:
  using Color = std::array<unsigned char, 3>;
  Canvas(int width, int height, Color ground);

  void fill(int x, int y, int width, int height, Color color);
  /// Draws a picture with its upper left corner at (x, y).
  void draw(int x, int y, const Picture& picture);
  /// Draws an antialiased line, about 1.5 pixels wide.
  void line(double x0, double y0, double x1, double y1, Color color);
  /// Adds text on top of the picture. Web pages show it; PNG files omit it.
  void label(Label label) { picture_.labels.push_back(std::move(label)); }

  const Picture& picture() const { return picture_; }

 private:
  void blend(int x, int y, Color color, double share);
  Picture picture_;
};

}  // namespace pelage
