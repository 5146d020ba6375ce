// SPDX-License-Identifier: Apache-2.0
#include "lab/report/report_page.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/check.h"
#include "lab/report/png.h"

namespace pelage {
namespace {

using Json = nlohmann::ordered_json;

// lab/report/page/report.js reads these names.

Json json_of(double number) {
  if (std::isinf(number)) return {{"infinite", number > 0 ? 1 : -1}};
  return number;  // NaN becomes null
}

Json json_of(const std::vector<double>& numbers) {
  Json json = Json::array();
  for (const double number : numbers) json.push_back(json_of(number));
  return json;
}

Json json_of(const std::vector<std::pair<double, double>>& points) {
  Json json = Json::array();
  for (const auto& [x, y] : points) json.push_back({json_of(x), json_of(y)});
  return json;
}

Json json_of(const Axis& axis) {
  return {{"label", axis.label},
          {"quantity", quantity_name(axis.quantity)},
          {"log", axis.log},
          {"end", json_of(axis.end)}};
}

Json json_of(const std::vector<Series>& list) {
  Json json = Json::array();
  for (const Series& series : list)
    json.push_back({{"name", series.name}, {"points", json_of(series.points)}});
  return json;
}

Json json_of(const Paragraph& paragraph) { return {{"kind", "paragraph"}, {"text", paragraph.text}}; }

Json json_of(const Table& table) {
  Json json{
      {"kind", "table"}, {"caption", table.caption}, {"columns", Json::array()}, {"rows", Json::array()}};
  for (const Column& column : table.columns)
    json["columns"].push_back({{"title", column.title}, {"quantity", quantity_name(column.quantity)}});
  for (const std::vector<Cell>& row : table.rows) {
    Json cells = Json::array();
    for (const Cell& cell : row) {
      const auto* text = std::get_if<Text>(&cell);
      cells.push_back(text ? Json(text->text) : json_of(std::get<double>(cell)));
    }
    json["rows"].push_back(std::move(cells));
  }
  return json;
}

Json json_of(const LinePlot& plot) {
  return {{"kind", "lines"},
          {"caption", plot.caption},
          {"half", plot.half},
          {"x", json_of(plot.x)},
          {"y", json_of(plot.y)},
          {"markers", plot.markers},
          {"areas", json_of(plot.areas)},
          {"lines", json_of(plot.lines)}};
}

Json json_of(const BarPlot& plot) {
  Json json{{"kind", "bars"},          {"caption", plot.caption},
            {"half", plot.half},       {"value", json_of(plot.value)},
            {"groups", plot.groups},   {"series", Json::array()},
            {"stacked", plot.stacked}, {"spread", json_of(plot.spread)},
            {"notes", plot.notes}};
  for (const BarPlot::Values& series : plot.series)
    json["series"].push_back({{"name", series.name}, {"values", json_of(series.values)}});
  return json;
}

Json json_of(const Picture& picture) {
  constexpr const char* kAnchors[] = {"start", "middle", "end"};
  Json json{{"kind", "picture"},        {"caption", picture.caption},
            {"half", picture.half},     {"width", picture.width},
            {"height", picture.height}, {"source", "data:image/png;base64," + base64(png_bytes(picture))},
            {"labels", Json::array()}};
  for (const Label& label : picture.labels) {
    json["labels"].push_back({{"x", label.x},
                              {"y", label.y},
                              {"text", label.text},
                              {"anchor", kAnchors[static_cast<size_t>(label.anchor)]},
                              {"color", label.color},
                              {"size", label.size}});
  }
  return json;
}

Json json_of(const Report& report) {
  Json json{{"title", report.title},
            {"abstract", report.abstract},
            {"facts", report.facts},
            {"sections", Json::array()}};
  for (const Section& section : report.sections) {
    Json blocks = Json::array();
    for (const Block& block : section.blocks)
      blocks.push_back(std::visit([](const auto& content) { return json_of(content); }, block));
    json["sections"].push_back({{"heading", section.heading}, {"blocks", std::move(blocks)}});
  }
  return json;
}

std::string_view page_file(std::string_view name) {
  const auto files = report_page_files();
  const auto found =
      std::find_if(files.begin(), files.end(), [&](const PageFile& file) { return file.name == name; });
  PELAGE_CHECK(found != files.end());
  return found->text;
}

/// JSON in which no markup can begin: `<` occurs in its strings only.
std::string embedded_json(const Report& report) {
  std::string text;
  for (const char c : json_of(report).dump(-1, ' ', false, Json::error_handler_t::replace))
    text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

}  // namespace

std::string report_page(const Report& report) {
  std::string_view rest = page_file("report.html");
  std::string page;
  for (size_t mark = 0; (mark = rest.find("{{")) != std::string_view::npos;) {
    const size_t end = rest.find("}}", mark);
    const std::string_view name = rest.substr(mark + 2, end - mark - 2);
    page += rest.substr(0, mark);
    if (name == "report.json") {
      page += embedded_json(report);
    } else {
      page += page_file(name);
    }
    rest.remove_prefix(end + 2);
  }
  return page + std::string(rest);
}

}  // namespace pelage
