// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/named_strands.h"

#include <algorithm>
#include <limits>
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

int64_t free_bytes(const MemoryLedger& ledger) {
  if (ledger.limit() == 0) return std::numeric_limits<int64_t>::max();
  return std::max<int64_t>(0, ledger.limit() - ledger.budgeted());
}

StrandFile read_named_strands(const AssetPath& file, const StrandReadOptions& options) {
  return with_errors_at_asset(file, [&] { return read_strands(file, options); });
}

}  // namespace pelage
