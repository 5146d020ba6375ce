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
  const auto mebibytes = [](int64_t n) { return static_cast<double>(n) / (1 << 20); };
  throw Error(ErrorKind::kMemory,
              fmt::format("{}: it needs {:.1f} MiB beside {:.1f} MiB that are taken; chunks come on top",
                          budget_text(what, limit), mebibytes(bytes), mebibytes(ledger.budgeted())));
}

}  // namespace pelage
