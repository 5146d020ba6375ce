// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/document.h"

namespace pelage {

/// A value in one line that shows all there is to it: {a: 'text', b: [null]}; quoted scalars in double
/// quotes.
inline std::string flat(const Value& value) {
  std::string text;
  switch (value.kind()) {
    case Value::Kind::kNull:
      return "null";
    case Value::Kind::kScalar:
      return value.quoted() ? '"' + value.text() + '"' : value.text();
    case Value::Kind::kList:
      for (const Value& item : value.items()) text += (text.empty() ? "" : ", ") + flat(item);
      return "[" + text + "]";
    case Value::Kind::kMap:
      for (const auto& entry : value.entries()) {
        text += (text.empty() ? "" : ", ") + entry.key + ": " + flat(entry.value);
      }
      return "{" + text + "}";
  }
  return text;
}

/// Lines of the error that `function` throws; none when it throws nothing.
template <class Function>
std::vector<std::string> error_lines(Function&& function) {
  std::vector<std::string> lines;
  try {
    function();
  } catch (const Error& error) {
    for (const Problem& problem : error.problems()) {
      const std::string where = to_string(problem.position);
      lines.push_back(where.empty() ? problem.message : where + ": " + problem.message);
    }
  }
  return lines;
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream stream(path, std::ios::binary);
  stream << text;
  ASSERT_TRUE(stream.good());
}

using Lines = std::vector<std::string>;

}  // namespace pelage
