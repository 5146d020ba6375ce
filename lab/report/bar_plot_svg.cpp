// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "lab/report/plot_frame.h"
#include "lab/report/plot_svg.h"

namespace pelage {
namespace {

constexpr double kRight = 60, kBottom = 44, kGroupGap = 8;

double value_of(const BarPlot::Values& series, size_t group) {
  return group < series.values.size() ? series.values[group] : NAN;
}

// Lengths of the bars of a group.
std::vector<double> ends(const BarPlot& plot) {
  std::vector<double> numbers;
  for (size_t group = 0; group < plot.groups.size(); ++group) {
    double sum = 0;
    for (const BarPlot::Values& series : plot.series) {
      const double value = value_of(series, group);
      if (!plot.stacked) numbers.push_back(value);
      sum += std::isfinite(value) ? value : 0;
    }
    if (plot.stacked) numbers.push_back(sum);
  }
  for (const auto& [min, max] : plot.spread) numbers.push_back(max);
  return numbers;
}

// Draws the range from min to max; returns the visible max.
double draw_spread(Svg& svg, const PlotScale& scale, const std::pair<double, double>& spread, double y) {
  if (!scale.shows(spread.first) || !scale.shows(spread.second) || spread.first == spread.second) return 0;
  const double x0 = scale.pixel(spread.first), x1 = scale.pixel(spread.second);
  svg.line(x0, y, x1, y, "axis");
  svg.line(x0, y - 3, x0, y + 3, "axis");
  svg.line(x1, y - 3, x1, y + 3, "axis");
  return spread.second;
}

}  // namespace

std::string bar_plot_svg(const BarPlot& plot) {
  double widest = 40;
  for (const std::string& group : plot.groups) widest = std::max(widest, text_width(group));
  const double width = plot.half ? 480 : 780, left = std::min(widest + 14, width / 2), right = width - kRight;
  const bool single = plot.stacked || plot.series.size() == 1;
  const double bar = single ? 16 : 12;
  const double group_height = (single ? bar : bar * static_cast<double>(plot.series.size())) + kGroupGap;

  std::vector<LegendEntry> legend;
  for (size_t i = 0; i < plot.series.size(); ++i)
    legend.push_back({plot.series[i].name, series_color(i), "", true});
  if (plot.series.size() == 1) legend.clear();
  const double top = legend_height(legend, right - left) + 8;
  const double bottom = top + group_height * static_cast<double>(std::max<size_t>(plot.groups.size(), 1));

  Svg svg(width, bottom + kBottom, plot.caption);
  const PlotScale scale = make_scale(plot.value, ends(plot), left, right);
  draw_x_axis(svg, scale, plot.value.label, top, bottom);
  const double zero = scale.pixel(scale.log ? scale.low : 0);
  for (size_t group = 0; group < plot.groups.size(); ++group) {
    const double y0 = top + group_height * static_cast<double>(group) + kGroupGap / 2;
    svg.text(left - 6, y0 + (group_height - kGroupGap) / 2 + 4, plot.groups[group], TextAnchor::kEnd);
    double sum = 0, y = y0;
    bool known = false;
    for (size_t i = 0; i < plot.series.size(); ++i) {
      const double value = value_of(plot.series[i], group);
      const bool shown = scale.shows(value);
      known |= shown;
      if (plot.stacked) {
        if (!shown) continue;
        svg.rectangle(scale.pixel(sum), y, std::max(scale.pixel(sum + value) - scale.pixel(sum), 0.0), bar,
                      series_color(i));
        sum += value;
      } else {
        const double end = shown ? scale.pixel(value) : zero;
        svg.rectangle(std::min(zero, end), y, std::abs(end - zero), bar - 1, series_color(i));
        if (shown || plot.notes.empty()) {
          svg.text(std::max(end, zero) + 4, y + bar - 3, number_text(value, scale.unit), TextAnchor::kStart,
                   "value");
        }
        y += bar;
      }
    }
    double end = sum;
    if (group < plot.spread.size())
      end = std::max(end, draw_spread(svg, scale, plot.spread[group], y0 + bar / 2));
    const bool noted = !known && group < plot.notes.size() && !plot.notes[group].empty();
    if (noted || plot.stacked) {
      svg.text((known ? scale.pixel(end) : zero) + 4, y0 + bar - 4,
               noted ? plot.notes[group] : number_text(known ? sum : NAN, scale.unit), TextAnchor::kStart,
               "value");
    }
  }
  svg.line(zero, top, zero, bottom, "axis");
  draw_legend(svg, legend, left, right - left);
  return std::move(svg).finish();
}

}  // namespace pelage
