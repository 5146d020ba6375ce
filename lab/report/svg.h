// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lab/report/label.h"

namespace pelage {

/// Builds one inline SVG picture. Lengths in pixels at 1:1, y down. Colours and fonts come from plot_style(),
/// which a page includes once: every element has a class, and colours are named by series_color().
class Svg {
 public:
  /// `description`: text for screen readers.
  Svg(double width, double height, std::string_view description);

  void line(double x0, double y0, double x1, double y1, std::string_view style_class);
  /// Points as alternating x and y. An empty dash is a solid line.
  void polyline(const std::vector<double>& points, std::string_view color, std::string_view dash);
  void polygon(const std::vector<double>& points, std::string_view color);
  void rectangle(double x, double y, double width, double height, std::string_view color);
  void dot(double x, double y, std::string_view color);
  void text(double x, double y, std::string_view text, TextAnchor anchor,
            std::string_view style_class = "label");
  /// Reads from bottom to top, centred at y.
  void upright_text(double x, double y, std::string_view text);

  void label(const Label& label);
  /// Embeds a PNG file, stretched to the given size.
  void image(double x, double y, double width, double height, std::string_view png);

  /// The finished element.
  std::string finish() &&;

 private:
  std::string out_;
};

/// Approximate width of a label in browsers, for layout; `size`: of the font.
double text_width(std::string_view text, double size = 11.5);

/// Classes of series: distinguishable for colour-blind readers and, by their dashes, without colours.
std::string series_color(size_t index);
std::string_view series_dash(size_t index);
/// The class of everything drawn in the text colour.
constexpr std::string_view kInkColor = "ink";

enum class Paper { kLight, kDark };
/// Style sheet of all plots, for a page with that background.
std::string plot_style(Paper paper);
/// An inline picture as a standalone file, on a light background.
std::string standalone_svg(const std::string& svg);

}  // namespace pelage
