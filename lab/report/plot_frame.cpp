// SPDX-License-Identifier: Apache-2.0
#include "lab/report/plot_frame.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "lab/report/axis_ticks.h"

namespace pelage {
namespace {

constexpr double kLegendLine = 18, kSwatch = 22, kLegendGap = 16;

std::vector<double> ticks_of(const PlotScale& scale) {
  const double low = scale.low * scale.unit.factor, high = scale.high * scale.unit.factor;
  if (scale.log) return log_ticks(low, high);
  return linear_ticks(low, high, std::max(2, static_cast<int>(std::abs(scale.to - scale.from) / 50)));
}

// Calls `place` with the left edge and the line of each entry; returns the number of lines.
int lay_out(const std::vector<LegendEntry>& entries, double width,
            const std::function<void(const LegendEntry&, double, int)>& place) {
  double x = 0;
  int row = 0;
  for (const LegendEntry& entry : entries) {
    const double needed = kSwatch + text_width(entry.name);
    if (x > 0 && x + needed > width) {
      x = 0;
      ++row;
    }
    place(entry, x, row);
    x += needed + kLegendGap;
  }
  return entries.empty() ? 0 : row + 1;
}

}  // namespace

double PlotScale::pixel(double number) const {
  const double t = log ? std::log(number / low) / std::log(high / low) : (number - low) / (high - low);
  return from + t * (to - from);
}

bool PlotScale::shows(double number) const { return std::isfinite(number) && (!log || number > 0); }

PlotScale make_scale(const Axis& axis, const std::vector<double>& numbers, double from, double to) {
  double smallest = INFINITY, largest = axis.end;
  for (const double number : numbers) {
    if (!std::isfinite(number) || (axis.log && number <= 0)) continue;
    smallest = std::min(smallest, number);
    largest = std::max(largest, number);
  }
  PlotScale scale;
  scale.from = from;
  scale.to = to;
  scale.log = axis.log;
  if (axis.log) {
    if (!(largest > 0)) largest = 1;
    smallest = std::min(smallest, largest);
    scale.low = smallest / 1.15;
    scale.high = largest * 1.15;
  } else {
    if (!std::isfinite(smallest)) smallest = 0;
    if (smallest >= 0 && !(largest > 0)) largest = 1;
    const double room = 0.04 * (std::max(largest, 0.0) - std::min(smallest, 0.0));
    scale.low = smallest < 0 ? smallest - room : 0;
    scale.high = std::max(largest, 0.0) + room;
  }
  scale.unit = display_unit(axis.quantity, std::max(std::abs(scale.low), scale.high));
  return scale;
}

void draw_x_axis(Svg& svg, const PlotScale& scale, const std::string& label, double top, double bottom) {
  const std::vector<double> ticks = ticks_of(scale);
  const std::vector<std::string> labels = tick_labels(ticks, scale.log);
  for (size_t i = 0; i < ticks.size(); ++i) {
    const double x = scale.pixel(ticks[i] / scale.unit.factor);
    svg.line(x, top, x, bottom, "grid");
    svg.text(x, bottom + 15, labels[i], TextAnchor::kMiddle);
  }
  svg.line(scale.from, bottom, scale.to, bottom, "axis");
  svg.text((scale.from + scale.to) / 2, bottom + 33, with_unit(label, scale.unit), TextAnchor::kMiddle);
}

void draw_y_axis(Svg& svg, const PlotScale& scale, const std::string& label, double left, double right) {
  const std::vector<double> ticks = ticks_of(scale);
  const std::vector<std::string> labels = tick_labels(ticks, scale.log);
  for (size_t i = 0; i < ticks.size(); ++i) {
    const double y = scale.pixel(ticks[i] / scale.unit.factor);
    svg.line(left, y, right, y, "grid");
    svg.text(left - 6, y + 4, labels[i], TextAnchor::kEnd);
  }
  svg.line(left, scale.from, left, scale.to, "axis");
  svg.upright_text(14, (scale.from + scale.to) / 2, with_unit(label, scale.unit));
}

double legend_height(const std::vector<LegendEntry>& entries, double width) {
  return kLegendLine * lay_out(entries, width, [](const LegendEntry&, double, int) {});
}

void draw_legend(Svg& svg, const std::vector<LegendEntry>& entries, double left, double width) {
  lay_out(entries, width, [&](const LegendEntry& entry, double x, int row) {
    const double y = kLegendLine * row + 12;
    if (entry.area) {
      svg.rectangle(left + x, y - 9, 16, 10, entry.color);
    } else {
      svg.polyline({left + x, y - 4, left + x + 17, y - 4}, entry.color, entry.dash);
    }
    svg.text(left + x + kSwatch, y, entry.name, TextAnchor::kStart);
  });
}

}  // namespace pelage
