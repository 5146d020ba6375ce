// SPDX-License-Identifier: Apache-2.0
#include "cli/report_error.h"

#include <algorithm>

#include "base/visible_text.h"
#include "cli/signals.h"

namespace pelage {

int exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kFailed:
      return 1;
    case ErrorKind::kArguments:
      return 2;
    case ErrorKind::kInput:
      return 3;
    case ErrorKind::kMemory:
      return 4;
    case ErrorKind::kStopped:
      return SignalGuard::exit_code();
  }
  return 1;
}

std::string error_text(const Error& error) {
  constexpr size_t kMaxLines = 50;
  const size_t shown = std::min(error.problems().size(), kMaxLines);
  std::string text;
  for (size_t i = 0; i < shown; ++i) {
    const Problem& problem = error.problems()[i];
    const std::string where = to_string(problem.position);
    text += visible((where.empty() ? "pelage: error" : where) + ": " + problem.message) + "\n";
  }
  const size_t left = error.problems().size() - shown;
  if (left > 0) text += "pelage: error: and " + std::to_string(left) + " more\n";
  return text;
}

}  // namespace pelage
