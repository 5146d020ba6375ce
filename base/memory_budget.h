// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/ledger.h"

namespace pelage {

/// Returns a size for a message: "1 byte", "640 KiB", "22.7 MiB" or "1.3 GiB".
std::string memory_text(int64_t bytes);

/// Describes the memory in use that `render.memory` includes, by tag: "30.0 MiB are in use (skins 20.0 MiB,
/// film 10.0 MiB)".
std::string in_use_text(const MemoryLedger& ledger);

/// Returns whether another `bytes` bytes fit the ledger's limit. True if the ledger has no limit.
bool has_room(const MemoryLedger& ledger, int64_t bytes);

/// Throws Error (kMemory) when another `bytes` bytes do not fit the ledger's limit. `what` names the object
/// that needs the memory and its location in the scene ("groom 'coat': the follicles of 5,000,000 strands").
/// The message adds the size, the memory in use, and the --memory (in MiB) that suffices for this object.
/// Later steps may need more.
void require_memory(const MemoryLedger& ledger, int64_t bytes, std::string_view what);

/// Calls require_memory(), then charges the bytes.
MemoryCharge reserve(MemoryLedger& ledger, MemoryTag tag, int64_t bytes, std::string_view what);

}  // namespace pelage
