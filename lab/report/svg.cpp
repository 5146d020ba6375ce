// SPDX-License-Identifier: Apache-2.0
#include "lab/report/svg.h"

#include <cmath>

#include <fmt/format.h>

#include "lab/report/markup.h"
#include "lab/report/png.h"

namespace pelage {
namespace {

// A tenth of a pixel is finer than screens and printers resolve. Adding zero turns -0 into 0.
std::string px(double value) { return fmt::format("{:.6g}", std::round(value * 10) / 10 + 0.0); }

std::string point_list(const std::vector<double>& points) {
  std::string list;
  for (size_t i = 0; i + 1 < points.size(); i += 2)
    list += (i ? " " : "") + px(points[i]) + "," + px(points[i + 1]);
  return list;
}

// After Okabe and Ito; on dark paper the dark ones are lighter.
constexpr size_t kColors = 10;
constexpr std::string_view kOnLight[kColors] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00",
                                                "#56b4e9", "#666666", "#8c564b", "#000000", "#b8b000"};
constexpr std::string_view kOnDark[kColors] = {"#3d9fd9", "#ee7733", "#1fbf94", "#d98cb8", "#eeb53a",
                                               "#8fd0f5", "#a0a0a0", "#b98478", "#ffffff", "#d6cf4a"};

const char* anchor_name(TextAnchor anchor) {
  return anchor == TextAnchor::kStart ? "start" : anchor == TextAnchor::kMiddle ? "middle" : "end";
}

}  // namespace

Svg::Svg(double width, double height, std::string_view description)
    : out_(fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
                       "height=\"{1}\" role=\"img\" aria-label=\"{2}\">\n",
                       px(width), px(height), escape_markup(description))) {}

void Svg::line(double x0, double y0, double x1, double y1, std::string_view style_class) {
  out_ += fmt::format("<line class=\"{}\" x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"/>\n", style_class, px(x0),
                      px(y0), px(x1), px(y1));
}

void Svg::polyline(const std::vector<double>& points, std::string_view color, std::string_view dash) {
  out_ += fmt::format("<polyline class=\"line {}\"{} points=\"{}\"/>\n", color,
                      dash.empty() ? "" : fmt::format(" stroke-dasharray=\"{}\"", dash), point_list(points));
}

void Svg::polygon(const std::vector<double>& points, std::string_view color) {
  out_ += fmt::format("<polygon class=\"fill {}\" points=\"{}\"/>\n", color, point_list(points));
}

void Svg::rectangle(double x, double y, double width, double height, std::string_view color) {
  out_ += fmt::format("<rect class=\"fill {}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", color,
                      px(x), px(y), px(width), px(height));
}

void Svg::dot(double x, double y, std::string_view color) {
  out_ += fmt::format("<circle class=\"fill {}\" cx=\"{}\" cy=\"{}\" r=\"3\"/>\n", color, px(x), px(y));
}

void Svg::text(double x, double y, std::string_view text, TextAnchor anchor, std::string_view style_class) {
  out_ += fmt::format("<text class=\"{}\" x=\"{}\" y=\"{}\" text-anchor=\"{}\">{}</text>\n", style_class,
                      px(x), px(y), anchor_name(anchor), escape_markup(text));
}

void Svg::upright_text(double x, double y, std::string_view text) {
  out_ += fmt::format(
      "<text class=\"label\" x=\"0\" y=\"0\" text-anchor=\"middle\" transform=\"translate({},{}) "
      "rotate(-90)\">{}</text>\n",
      px(x), px(y), escape_markup(text));
}

void Svg::label(const Label& label) {
  out_ += fmt::format(
      "<text x=\"{}\" y=\"{}\" text-anchor=\"{}\" "
      "style=\"font-size:{:g}px;fill:#{:02x}{:02x}{:02x}\">{}</text>\n",
      px(label.x), px(label.y), anchor_name(label.anchor), label.size, label.color[0], label.color[1],
      label.color[2], escape_markup(label.text));
}

void Svg::image(double x, double y, double width, double height, std::string_view png) {
  out_ +=
      fmt::format("<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" href=\"data:image/png;base64,{}\"/>\n",
                  px(x), px(y), px(width), px(height), base64(png));
}

std::string Svg::finish() && {
  out_ += "</svg>\n";
  return std::move(out_);
}

double text_width(std::string_view text, double size) {
  size_t characters = 0;
  for (const char c : text) characters += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  return 6.3 / 11.5 * size * static_cast<double>(characters);
}

std::string series_color(size_t index) { return "s" + std::to_string(index % kColors); }

std::string_view series_dash(size_t index) {
  constexpr std::string_view kDashes[] = {"", "7 3", "2 2.5", "9 3 2 3", "5 2 1 2 1 2"};
  return kDashes[index % std::size(kDashes)];
}

std::string plot_style(Paper paper) {
  const bool dark = paper == Paper::kDark;
  const std::string_view ink = dark ? "#e6e6e6" : "#222222";
  std::string style = fmt::format(
      "svg text {{ font: 11.5px 'Source Sans 3', 'Helvetica Neue', Arial, sans-serif; fill: {0}; }}\n"
      "svg text.value {{ font-size: 10.5px; }}\n"
      "svg .axis {{ stroke: {0}; stroke-width: 1; }} svg .grid {{ stroke: {1}; stroke-width: .8; }}\n"
      "svg .line {{ fill: none; stroke-width: 1.8; stroke-linejoin: round; }}\n"
      "svg .line.ink {{ stroke: {0}; }} svg .fill.ink {{ fill: {0}; }}\n",
      ink, dark ? "#3a3d42" : "#dddddd");
  for (size_t i = 0; i < kColors; ++i) {
    style += fmt::format("svg .line.s{0} {{ stroke: {1}; }} svg .fill.s{0} {{ fill: {1}; }}\n", i,
                         (dark ? kOnDark : kOnLight)[i]);
  }
  return style;
}

std::string standalone_svg(const std::string& svg) {
  const size_t head = svg.find(">\n");
  if (head == std::string::npos) return svg;
  return svg.substr(0, head + 2) + "<style>" + plot_style(Paper::kLight) +
         "</style>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" + svg.substr(head + 2);
}

}  // namespace pelage
