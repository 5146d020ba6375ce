// SPDX-License-Identifier: Apache-2.0
#include "lab/report/report.h"

#include <algorithm>

namespace pelage {

const char* quantity_name(Quantity quantity) {
  constexpr const char* kNames[] = {"count", "seconds", "bytes", "rate", "ratio", "percent", "error"};
  return kNames[static_cast<size_t>(quantity)];
}

Table select(const Table& table, const std::vector<std::string>& keys, std::string caption) {
  Table result{std::move(caption), {}, std::vector<std::vector<Cell>>(table.rows.size())};
  for (const std::string& key : keys) {
    const auto found = std::find_if(table.columns.begin(), table.columns.end(),
                                    [&](const Column& column) { return column.key == key; });
    if (found == table.columns.end()) continue;
    result.columns.push_back(*found);
    const auto index = static_cast<size_t>(found - table.columns.begin());
    for (size_t row = 0; row < table.rows.size(); ++row) result.rows[row].push_back(table.rows[row][index]);
  }
  return result;
}

}  // namespace pelage
