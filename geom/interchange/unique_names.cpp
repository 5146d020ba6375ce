// SPDX-License-Identifier: Apache-2.0
#include "geom/interchange/unique_names.h"

#include <fmt/format.h>

namespace pelage {

std::string identifier(std::string_view text) {
  std::string name;
  for (const char c : text) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    const bool digit = c >= '0' && c <= '9';
    if (digit && name.empty()) name += '_';
    name += letter || digit ? c : '_';
  }
  return name.empty() ? "_" : name;
}

std::string UniqueNames::unique(std::string_view text) {
  const std::string name = identifier(text);
  std::string result = name;
  for (int i = 2; !used_.insert(result).second; ++i) result = fmt::format("{}_{}", name, i);
  return result;
}

}  // namespace pelage
