// SPDX-License-Identifier: Apache-2.0
#include "base/file_name.h"

#include <cstddef>

#include <fmt/format.h>

#include "base/hash.h"

namespace pelage {

std::string file_name_of(const std::vector<std::string>& parts) {
  constexpr size_t kLongest = 120, kKept = 80;
  std::string name;
  for (size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) name += '.';
    if (parts[i].empty()) name += '=';  // no other part is a single '='
    for (const char c : parts[i]) {
      const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
      if (letter || c == '_' || (c == '-' && !name.empty())) {
        name += c;
      } else {
        name += fmt::format("={:02X}", static_cast<unsigned char>(c));
      }
    }
  }
  if (name.size() <= kLongest) return name;
  // "==" occurs in no other name. The name is a function of the parts that can be undone, so it has their
  // hash.
  return name.substr(0, kKept) + "==" + to_string(content_hash(std::as_bytes(std::span(name))));
}

}  // namespace pelage
