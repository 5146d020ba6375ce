// SPDX-License-Identifier: Apache-2.0
#include "render/memory_budget.h"

#include <fmt/format.h>

#include "base/error.h"

namespace pelage {

std::string budget_text(std::string_view what, uint64_t limit) {
  return fmt::format("{} does not fit render.memory ({:.1f} MiB)", what,
                     static_cast<double>(limit) / (1 << 20));
}

void require_room(const MemoryLedger& ledger, uint64_t limit, int64_t bytes, std::string_view what) {
  const int64_t needed = ledger.budgeted() + bytes;
  if (limit == 0 || needed <= static_cast<int64_t>(limit)) return;
  throw Error(ErrorKind::kMemory, fmt::format("{}: {:.1f} MiB are needed so far", budget_text(what, limit),
                                              static_cast<double>(needed) / (1 << 20)));
}

}  // namespace pelage
