// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lab/report/report.h"
#include "lab/report/svg.h"

namespace pelage {

/// Maps the numbers of one axis to pixels.
struct PlotScale {
  double low = 0, high = 1;  ///< numbers at the two ends, in raw units
  double from = 0, to = 1;   ///< positions of the two ends in pixels
  bool log = false;
  DisplayUnit unit;

  double pixel(double number) const;
  /// Whether a number can be shown: it must be finite and, on a logarithmic scale, positive.
  bool shows(double number) const;
};

/// Returns a scale up to the largest of `numbers`, or up to axis.end if that is larger. A linear scale starts
/// at 0, or at the smallest number if this is negative. A logarithmic scale starts at the smallest positive
/// number. There is a small margin at both ends, but not at 0. `from` and `to` are the pixels at the ends.
PlotScale make_scale(const Axis& axis, const std::vector<double>& numbers, double from, double to);

/// draw_x_axis() and draw_y_axis() draw ticks, labels, grid lines and the title of the axis. Vertical grid
/// lines run from pixel `top` to `bottom`, horizontal ones from `left` to `right`.
void draw_x_axis(Svg& svg, const PlotScale& scale, const std::string& label, double top, double bottom);
void draw_y_axis(Svg& svg, const PlotScale& scale, const std::string& label, double left, double right);

/// A name in a legend and the symbol beside it.
struct LegendEntry {
  std::string name, color, dash;
  bool area = false;  ///< whether the symbol is a filled area; otherwise, it is a line
};

/// Returns the height of a legend of these entries within `width`. draw_legend() draws the legend from y = 0
/// down.
double legend_height(const std::vector<LegendEntry>& entries, double width);
void draw_legend(Svg& svg, const std::vector<LegendEntry>& entries, double left, double width);

}  // namespace pelage
