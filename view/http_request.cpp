// SPDX-License-Identifier: Apache-2.0
#include "view/http_request.h"

#include <algorithm>
#include <charconv>

namespace pelage {
namespace {

/// Decodes %2F and the like. `spaces`: whether '+' means a space.
std::string decoded(std::string_view text, bool spaces) {
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    char c = spaces && text[i] == '+' ? ' ' : text[i];
    if (c == '%' && i + 2 < text.size()) {
      unsigned char byte = 0;
      const char* end = text.data() + i + 3;
      const auto [rest, error] = std::from_chars(text.data() + i + 1, end, byte, 16);
      if (error == std::errc() && rest == end) {
        c = static_cast<char>(byte);
        i += 2;
      }
    }
    result += c;
  }
  return result;
}

}  // namespace

std::string HttpRequest::parameter(std::string_view name) const {
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [=](const auto& parameter) { return parameter.first == name; });
  return found == parameters.end() ? "" : found->second;
}

void read_target(std::string_view target, HttpRequest& request) {
  const size_t mark = std::min(target.find('?'), target.size());
  request.path = target.starts_with('/') ? decoded(target.substr(0, mark), false) : "";
  request.parameters.clear();
  for (size_t at = mark + 1; at < target.size();) {
    const size_t end = std::min(target.find('&', at), target.size());
    const std::string_view pair = target.substr(at, end - at);
    const size_t equals = std::min(pair.find('='), pair.size());
    request.parameters.emplace_back(decoded(pair.substr(0, equals), true),
                                    decoded(pair.substr(std::min(equals + 1, pair.size())), true));
    at = end + 1;
  }
}

}  // namespace pelage
