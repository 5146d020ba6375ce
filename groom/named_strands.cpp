// SPDX-License-Identifier: Apache-2.0
#include "groom/named_strands.h"

#include <utility>
#include <vector>

#include "base/error.h"

namespace pelage {

StrandFile read_named_strands(const AssetPath& file, const StrandReadOptions& options) {
  try {
    return read_strands(file.path, options);
  } catch (const Error& error) {
    if (file.position.file.empty()) throw;
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) {
      const std::string in = to_string(problem.position);
      problem.message = in.empty() ? problem.message : in + ": " + problem.message;
      problem.position = file.position;
    }
    throw Error(error.kind(), std::move(problems));
  }
}

}  // namespace pelage
