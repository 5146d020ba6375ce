// SPDX-License-Identifier: Apache-2.0
#include "geom/interchange/read_budget.h"

#include <fmt/format.h>

#include "base/memory_budget.h"

namespace pelage {

void ReadBudget::charge(int64_t bytes, const SourcePosition& place) {
  if (bytes <= max_bytes_ - used_bytes_) {
    used_bytes_ += bytes;
    return;
  }
  throw Error(
      ErrorKind::kMemory, place,
      fmt::format("reading this file needs more than the {} that the memory limit leaves; raise --memory",
                  memory_text(max_bytes_)));
}

}  // namespace pelage
