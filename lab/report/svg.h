// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lab/report/label.h"

namespace pelage {

/// Builds one inline SVG picture. Lengths are in pixels; y points down. Colours and fonts come from
/// plot_style(), which a page includes once. Every element therefore has a style class. Parameters called
/// `color` take names from series_color().
class Svg {
 public:
  /// `width` and `height`: size of the picture. `description`: text for screen readers.
  Svg(double width, double height, std::string_view description);

  void line(double x0, double y0, double x1, double y1, std::string_view style_class);
  /// Draws a line through points, given as alternating x and y. If `dash` is empty, the line is solid.
  void polyline(const std::vector<double>& points, std::string_view color, std::string_view dash);
  void polygon(const std::vector<double>& points, std::string_view color);
  void rectangle(double x, double y, double width, double height, std::string_view color);
  void dot(double x, double y, std::string_view color);
  void text(double x, double y, std::string_view text, TextAnchor anchor,
            std::string_view style_class = "label");
  /// Draws text that runs from bottom to top, centred at y.
  void upright_text(double x, double y, std::string_view text);

  void label(const Label& label);
  /// Embeds the PNG file `png`, stretched to the given size.
  void image(double x, double y, double width, double height, std::string_view png);

  /// Returns the finished SVG element.
  std::string finish() &&;

 private:
  std::string out_;
};

/// Returns the approximate width in pixels of a text in browsers, for layout. `size` is the size of the font.
double text_width(std::string_view text, double size = 11.5);

/// series_color() returns the style class of a series, series_dash() its dash pattern. The colours are
/// distinguishable for colour-blind readers. The dash patterns distinguish lines without colours.
std::string series_color(size_t index);
std::string_view series_dash(size_t index);
/// Style class of everything that has the colour of text.
constexpr std::string_view kInkColor = "ink";

enum class Paper { kLight, kDark };
/// Returns the style sheet of all plots, for a page with this background.
std::string plot_style(Paper paper);
/// Returns an inline SVG picture as the content of a standalone file with a light background.
std::string standalone_svg(const std::string& svg);

}  // namespace pelage
