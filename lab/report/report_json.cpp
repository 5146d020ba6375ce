// SPDX-License-Identifier: Apache-2.0
#include "lab/report/report_json.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace pelage {
namespace {

using Json = nlohmann::ordered_json;

/// The unit of raw numbers.
const char* raw_unit(Quantity quantity) {
  switch (quantity) {
    case Quantity::kSeconds:
      return "s";
    case Quantity::kBytes:
      return "bytes";
    case Quantity::kRate:
      return "1/s";
    default:
      return "";
  }
}

Json cell_json(const Cell& cell) {
  if (const auto* text = std::get_if<Text>(&cell)) return text->text;
  const double number = std::get<double>(cell);
  if (!std::isfinite(number)) return nullptr;
  if (number == std::round(number) && std::abs(number) < 9007199254740992.0)
    return static_cast<int64_t>(number);
  return number;
}

Json columns_json(const Table& table) {
  Json columns = Json::array();
  for (const Column& column : table.columns) {
    columns.push_back({{"key", column.key}, {"title", column.title}, {"unit", raw_unit(column.quantity)}});
  }
  return columns;
}

Json rows_json(const Table& table) {
  Json rows = Json::array();
  for (const std::vector<Cell>& row : table.rows) {
    Json object = Json::object();
    for (size_t i = 0; i < row.size(); ++i) object[table.columns[i].key] = cell_json(row[i]);
    rows.push_back(std::move(object));
  }
  return rows;
}

}  // namespace

std::string report_json(const Report& report) {
  Json json{{"schema", kReportSchema}, {"experiment", report.experiment}, {"title", report.title}};
  json["facts"] = Json::object();
  for (const auto& [name, value] : report.facts) json["facts"][name] = value;
  json["columns"] = columns_json(report.data);
  json["rows"] = rows_json(report.data);
  json["runs"] = report.runs.empty() ? Json::array() : Json::parse(report.runs);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace pelage
