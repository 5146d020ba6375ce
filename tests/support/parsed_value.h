// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/value.h"

namespace pelage {

// Values for tests of readers, without a parser. Positions have file "t" and the line.

inline Value scalar(std::string text, int line = 1, bool quoted = false) {
  return Value::scalar({"t", line, 1}, std::move(text), quoted);
}
inline Value list(std::vector<Value> items, int line = 1) {
  return Value::list({"t", line, 1}, std::move(items));
}
inline Value numbers(const std::vector<std::string>& texts) {
  std::vector<Value> items;
  for (const std::string& text : texts) items.push_back(scalar(text));
  return list(std::move(items));
}
/// Key i is on line i + 1.
inline Value block(std::vector<std::pair<std::string, Value>> entries) {
  std::vector<Value::Entry> result;
  for (auto& [key, value] : entries) {
    result.push_back({key, {"t", static_cast<int>(result.size()) + 1, 1}, std::move(value)});
  }
  return Value::map({"t", 1, 1}, std::move(result));
}

}  // namespace pelage
