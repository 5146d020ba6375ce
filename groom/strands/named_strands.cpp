// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/named_strands.h"

#include <utility>
#include <vector>

namespace pelage {

void rethrow_at_asset(const Error& error, const AssetPath& file) {
  std::vector<Problem> problems = error.problems();
  if (!file.position.file.empty()) {
    for (Problem& problem : problems) {
      const std::string in = to_string(problem.position);
      problem.message = in.empty() ? problem.message : in + ": " + problem.message;
      problem.position = file.position;
    }
  }
  throw Error(error.kind(), std::move(problems));
}

StrandFile read_named_strands(const AssetPath& file, const StrandReadOptions& options) {
  return with_errors_at_asset(file, [&] { return read_strands(file, options); });
}

}  // namespace pelage
