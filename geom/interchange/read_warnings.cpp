// SPDX-License-Identifier: Apache-2.0
#include "geom/interchange/read_warnings.h"

#include <fmt/format.h>

#include "base/visible_text.h"

namespace pelage {

namespace {
constexpr size_t kMaxWarningKinds = 50;
}

void ReadWarnings::add(const std::string& kind, const SourcePosition& place) {
  for (Case& known : cases_) {
    if (known.kind != kind || known.place.file != place.file) continue;
    ++known.count;
    return;
  }
  if (cases_.size() < kMaxWarningKinds) cases_.push_back({kind, place, 1});
}

std::vector<std::string> ReadWarnings::lines() const {
  std::vector<std::string> lines;
  for (const Case& one : cases_) {
    lines.push_back(visible(to_string(one.place) + ": " + one.kind));
    if (one.count > 1) lines.back() += fmt::format(" ({} times)", one.count);
  }
  return lines;
}

}  // namespace pelage
