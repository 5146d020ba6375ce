// SPDX-License-Identifier: Apache-2.0
#include "base/memory_budget.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/counted.h"
#include "base/error.h"

namespace pelage {

std::string memory_text(int64_t bytes) {
  const auto size = static_cast<double>(bytes);
  if (bytes < 10 << 10) return counted(bytes, "byte");
  if (bytes < int64_t{1} << 20) return fmt::format("{:.0f} KiB", size / (1 << 10));
  if (bytes < int64_t{1} << 30) return fmt::format("{:.1f} MiB", size / (1 << 20));
  return fmt::format("{:.1f} GiB", size / (1 << 30));
}

std::string in_use_text(const MemoryLedger& ledger) {
  if (ledger.budgeted() <= 0) return "nothing is in use yet";
  std::string parts;
  for (int i = 0; i < static_cast<int>(MemoryTag::kCount); ++i) {
    const auto tag = static_cast<MemoryTag>(i);
    if (!MemoryLedger::is_budgeted(tag) || ledger.current(tag) <= 0) continue;
    parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", memory_tag_name(tag),
                         memory_text(ledger.current(tag)));
  }
  return fmt::format("{} are in use ({})", memory_text(ledger.budgeted()), parts);
}

bool has_room(const MemoryLedger& ledger, int64_t bytes) {
  return ledger.limit() == 0 || ledger.budgeted() + bytes <= ledger.limit();
}

void require_memory(const MemoryLedger& ledger, int64_t bytes, std::string_view what) {
  if (has_room(ledger, bytes)) return;
  const int64_t needed = ledger.budgeted() + bytes + ledger.elastic();
  throw Error(
      ErrorKind::kMemory,
      fmt::format("{} needs {}, but {} is {} and {}; give at least --memory {}M", what, memory_text(bytes),
                  ledger.limit_name(), memory_text(ledger.limit()), in_use_text(ledger), (needed >> 20) + 1));
}

MemoryCharge reserve(MemoryLedger& ledger, MemoryTag tag, int64_t bytes, std::string_view what) {
  require_memory(ledger, bytes, what);
  return {ledger, tag, bytes};
}

}  // namespace pelage
