// SPDX-License-Identifier: Apache-2.0
#include "lab/report/report_csv.h"

#include <cmath>

#include <fmt/format.h>

namespace pelage {
namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

std::string cell_text(const Cell& cell) {
  if (const auto* text = std::get_if<Text>(&cell)) return quoted(text->text);
  const double number = std::get<double>(cell);
  // Counts up to 2^53 are written out, not as 1e+06.
  if (std::isfinite(number) && number == std::round(number) && std::abs(number) < 9007199254740992.0)
    return fmt::format("{:.0f}", number + 0.0);
  return std::isnan(number) ? "" : fmt::format("{}", number);
}

}  // namespace

std::string csv_text(const Table& table) {
  std::string out;
  for (size_t i = 0; i < table.columns.size(); ++i) out += (i ? "," : "") + quoted(table.columns[i].key);
  out += "\r\n";
  for (const std::vector<Cell>& row : table.rows) {
    for (size_t i = 0; i < row.size(); ++i) out += (i ? "," : "") + cell_text(row[i]);
    out += "\r\n";
  }
  return out;
}

}  // namespace pelage
