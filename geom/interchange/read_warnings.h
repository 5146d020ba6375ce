// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/error.h"

namespace pelage {

/// Collects warnings about data that a reader skips or approximates. Each kind gives one warning per file,
/// with the place of the first case and the number of cases.
class ReadWarnings {
 public:
  void add(const std::string& kind, const SourcePosition& place);
  /// Returns one line per kind and file, in the order in which they were added: "file:3:5: PointInstancer
  /// prims are skipped (12 times)".
  std::vector<std::string> lines() const;

 private:
  struct Case {
    std::string kind;
    SourcePosition place;
    size_t count = 0;
  };
  std::vector<Case> cases_;
};

}  // namespace pelage
