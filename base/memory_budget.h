// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/ledger.h"

namespace pelage {

/// "640 KiB", "22.7 MiB", "1.3 GiB".
std::string memory_text(int64_t bytes);

/// The ledger's use of the budget: "30.0 MiB are in use (skins 20.0 MiB, film 10.0 MiB)".
std::string in_use_text(const MemoryLedger& ledger);

/// Whether `bytes` more fit the ledger's limit.
bool has_room(const MemoryLedger& ledger, int64_t bytes);

/// Throws Error (kMemory) when `bytes` more do not fit the ledger's limit. `what` names the object and its
/// place in the scene ("groom 'coat': the follicles of 5,000,000 strands"); the message adds the size, the
/// memory in use, and the smallest --memory that would suffice. Later steps may need more.
void require_room(const MemoryLedger& ledger, int64_t bytes, std::string_view what);

/// Calls require_room(), then charges the bytes.
MemoryCharge reserve(MemoryLedger& ledger, MemoryTag tag, int64_t bytes, std::string_view what);

}  // namespace pelage
