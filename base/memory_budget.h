// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/ledger.h"

namespace pelage {

/// "640 KiB", "22.7 MiB", "1.3 GiB".
std::string memory_text(int64_t bytes);

/// What the ledger holds of the budget: "30.0 MiB are in use (skins 20.0 MiB, film 10.0 MiB)".
std::string in_use_text(const MemoryLedger& ledger);

/// Throws Error (kMemory) when `bytes` more do not fit into the ledger's limit. `what` names the thing and
/// its place in the scene ("groom 'coat': the follicles of 5,000,000 strands"); the message adds how much it
/// needs, what is in use, and the least --memory that would hold it. Later steps may need more.
void require_room(const MemoryLedger& ledger, int64_t bytes, std::string_view what);

/// require_room(), then the charge.
MemoryCharge reserve(MemoryLedger& ledger, MemoryTag tag, int64_t bytes, std::string_view what);

}  // namespace pelage
