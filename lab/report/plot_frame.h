// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lab/report/report.h"
#include "lab/report/svg.h"

namespace pelage {

/// Maps numbers to pixels along one axis.
struct PlotScale {
  double low = 0, high = 1;  ///< raw numbers at the ends
  double from = 0, to = 1;   ///< pixels at the ends
  bool log = false;
  DisplayUnit unit;

  double pixel(double number) const;
  /// Whether a number lies on this scale.
  bool shows(double number) const;
};

/// A scale from zero (or, on a log axis, from the smallest positive number) to the largest of `numbers`, with
/// a small margin. Never empty.
PlotScale make_scale(const Axis& axis, const std::vector<double>& numbers, double from, double to);

/// Draws ticks, labels, grid lines and the axis title. Grid lines run between the pixels `top` and `bottom`.
void draw_x_axis(Svg& svg, const PlotScale& scale, const std::string& label, double top, double bottom);
void draw_y_axis(Svg& svg, const PlotScale& scale, const std::string& label, double left, double right);

/// Symbol beside a name in a legend.
struct LegendEntry {
  std::string name, color, dash;
  bool area = false;
};

/// Height of a legend of these entries within `width`; draw_legend puts it at y = 0.
double legend_height(const std::vector<LegendEntry>& entries, double width);
void draw_legend(Svg& svg, const std::vector<LegendEntry>& entries, double left, double width);

}  // namespace pelage
