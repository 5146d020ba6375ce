// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/ledger.h"

namespace pelage {

/// "the film does not fit render.memory (64 MiB)".
std::string budget_text(std::string_view what, uint64_t limit);

/// Throws Error (kMemory) when what the ledger holds of `render.memory` and `bytes` more exceed `limit`
/// bytes; 0 is no limit. `what` needs them: "the film".
void require_room(const MemoryLedger& ledger, uint64_t limit, int64_t bytes, std::string_view what);

}  // namespace pelage
