// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lab/report/label.h"

namespace pelage {

/// Builds one inline SVG picture. Lengths are pixels at the size of 1 : 1, y down. All colours and fonts are
/// those of plot_style(), which stands once on a page: every element has a class, and colours are named by
/// series_color().
class Svg {
 public:
  /// `description` is what a screen reader says.
  Svg(double width, double height, std::string_view description);

  void line(double x0, double y0, double x1, double y1, std::string_view style_class);
  /// Points x, y in turn. An empty dash is a solid line.
  void polyline(const std::vector<double>& points, std::string_view color, std::string_view dash);
  void polygon(const std::vector<double>& points, std::string_view color);
  void rectangle(double x, double y, double width, double height, std::string_view color);
  void dot(double x, double y, std::string_view color);
  void text(double x, double y, std::string_view text, TextAnchor anchor,
            std::string_view style_class = "label");
  /// Read from below to above, centred at y.
  void upright_text(double x, double y, std::string_view text);

  void label(const Label& label);
  /// A PNG file, stretched.
  void image(double x, double y, double width, double height, std::string_view png);

  /// The finished element.
  std::string finish() &&;

 private:
  std::string out_;
};

/// Width of a label about as browsers set it, for layout; `size` is that of the font.
double text_width(std::string_view text, double size = 11.5);

/// Classes of series: their colours stay apart for colour-blind readers and, by their dashes, without
/// colours.
std::string series_color(size_t index);
std::string_view series_dash(size_t index);
/// The class of what is drawn in the colour of text.
constexpr std::string_view kInkColor = "ink";

enum class Paper { kLight, kDark };
/// Style sheet of all plots, for a page of that background.
std::string plot_style(Paper paper);
/// An inline picture as a file of its own, on a light background.
std::string standalone_svg(const std::string& svg);

}  // namespace pelage
