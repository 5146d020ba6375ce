// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <algorithm>

namespace pelage {

std::string to_string(const SourcePosition& position) {
  std::string text = position.file;
  if (position.line > 0) text += ":" + std::to_string(position.line);
  if (position.line > 0 && position.column > 0) text += ":" + std::to_string(position.column);
  return text;
}

Error::Error(ErrorKind kind, std::vector<Problem> problems) : kind_(kind), problems_(std::move(problems)) {
  for (const Problem& problem : problems_) {
    if (!text_.empty()) text_ += '\n';
    const std::string where = to_string(problem.position);
    text_ += where.empty() ? problem.message : where + ": " + problem.message;
  }
}

void Problems::sort_by_line() {
  std::stable_sort(list_.begin(), list_.end(),
                   [](const Problem& a, const Problem& b) { return a.position.line < b.position.line; });
}

void Problems::throw_if_any(ErrorKind kind) const {
  if (list_.empty()) return;
  std::vector<Problem> problems = list_;
  if (omitted_ > 0) {
    std::string more = std::to_string(omitted_) + " more problems";
    problems.push_back({{problems.front().position.file, 0, 0}, std::move(more)});
  }
  throw Error(kind, std::move(problems));
}

}  // namespace pelage
