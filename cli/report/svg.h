// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pelage {

enum class TextAnchor { kStart, kMiddle, kEnd };

/// Builds one inline SVG picture. Lengths are pixels at the size of 1 : 1, y down; colours and fonts of axes,
/// labels and grid are those of the page's style sheet (classes `axis`, `grid`, `label`).
class Svg {
 public:
  /// `description` is what a screen reader says.
  Svg(double width, double height, std::string_view description);

  void line(double x0, double y0, double x1, double y1, std::string_view style_class);
  /// Points x, y in turn. An empty dash is a solid line.
  void polyline(const std::vector<double>& points, std::string_view color, std::string_view dash);
  void polygon(const std::vector<double>& points, std::string_view fill);
  void rectangle(double x, double y, double width, double height, std::string_view fill);
  void dot(double x, double y, std::string_view color);
  void text(double x, double y, std::string_view text, TextAnchor anchor,
            std::string_view style_class = "label");
  /// Read from below to above, centred at y.
  void upright_text(double x, double y, std::string_view text);

  /// The finished element.
  std::string finish() &&;

 private:
  std::string out_;
};

/// Width of a label about as browsers set it, for layout.
double text_width(std::string_view text);

/// Colours for series that stay apart for colour-blind readers and, by their dashes, without
/// colours.
std::string_view series_color(size_t index);
std::string_view series_dash(size_t index);

}  // namespace pelage
