// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "lab/report/plot_frame.h"
#include "lab/report/plot_svg.h"

namespace pelage {
namespace {

constexpr double kLeft = 66, kRight = 14, kBottom = 44;

// Cumulative sums of the areas at every x: bounds[i] is the lower bound of area i, bounds.back() the upper
// bound of the last.
std::vector<std::vector<double>> stack(const std::vector<Series>& areas) {
  std::vector<std::vector<double>> bounds;
  if (areas.empty()) return bounds;
  bounds.emplace_back(areas.front().points.size(), 0.0);
  for (const Series& area : areas) {
    std::vector<double> next = bounds.back();
    for (size_t i = 0; i < std::min(next.size(), area.points.size()); ++i) {
      const double y = area.points[i].second;
      next[i] += std::isfinite(y) ? y : 0;
    }
    bounds.push_back(std::move(next));
  }
  return bounds;
}

std::vector<LegendEntry> legend_of(const LinePlot& plot) {
  std::vector<LegendEntry> entries;
  for (size_t i = 0; i < plot.areas.size(); ++i)
    entries.push_back({plot.areas[i].name, series_color(i), "", true});
  for (size_t i = 0; i < plot.lines.size(); ++i) {
    // Above areas, lines have the colour of text, because other colours would be mistaken for areas.
    const std::string color = plot.areas.empty() ? series_color(i) : std::string(kInkColor);
    entries.push_back({plot.lines[i].name, color, std::string(series_dash(i)), false});
  }
  return entries;
}

void draw_line(Svg& svg, const Series& series, const LegendEntry& style, const PlotScale& x,
               const PlotScale& y, bool markers) {
  std::vector<double> run;
  const auto flush = [&] {
    if (run.size() > 2) svg.polyline(run, style.color, style.dash);
    run.clear();
  };
  for (const auto& [px, py] : series.points) {
    if (!x.shows(px) || !y.shows(py)) {
      flush();
      continue;
    }
    run.insert(run.end(), {x.pixel(px), y.pixel(py)});
    if (markers) svg.dot(x.pixel(px), y.pixel(py), style.color);
  }
  flush();
}

}  // namespace

std::string line_plot_svg(const LinePlot& plot) {
  const double width = plot.half ? 480 : 780, inner = width - kLeft - kRight;
  const std::vector<LegendEntry> legend = legend_of(plot);
  const double top = legend_height(legend, inner) + 8, bottom = top + (plot.half ? 200 : 260);
  const std::vector<std::vector<double>> stacked = stack(plot.areas);

  std::vector<double> xs, ys;
  for (const std::vector<Series>* list : {&plot.areas, &plot.lines}) {
    for (const Series& series : *list) {
      for (const auto& [x, y] : series.points) {
        xs.push_back(x);
        if (list == &plot.lines) ys.push_back(y);
      }
    }
  }
  for (const std::vector<double>& bound : stacked) ys.insert(ys.end(), bound.begin(), bound.end());

  Svg svg(width, bottom + kBottom, plot.caption);
  const PlotScale x = make_scale(plot.x, xs, kLeft, kLeft + inner);
  const PlotScale y = make_scale(plot.y, ys, bottom, top);
  draw_x_axis(svg, x, plot.x.label, top, bottom);
  draw_y_axis(svg, y, plot.y.label, kLeft, kLeft + inner);
  for (size_t i = 0; i < plot.areas.size(); ++i) {
    const std::vector<std::pair<double, double>>& points = plot.areas.front().points;
    std::vector<double> outline;
    for (size_t j = 0; j < points.size(); ++j)
      outline.insert(outline.end(), {x.pixel(points[j].first), y.pixel(stacked[i + 1][j])});
    for (size_t j = points.size(); j-- > 0;)
      outline.insert(outline.end(), {x.pixel(points[j].first), y.pixel(stacked[i][j])});
    svg.polygon(outline, legend[i].color);
  }
  for (size_t i = 0; i < plot.lines.size(); ++i)
    draw_line(svg, plot.lines[i], legend[plot.areas.size() + i], x, y, plot.markers);
  draw_legend(svg, legend, kLeft, inner);
  return std::move(svg).finish();
}

}  // namespace pelage
