// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "base/ledger.h"

namespace pelage {

/// Resident pages of this process, in bytes.
struct ResidentMemory {
  int64_t anonymous = 0;  ///< heap, stacks and other private pages: the part that a ledger can explain
  int64_t file = 0;       ///< pages of mapped files: the program itself, libraries, caches
};

/// Current values of the kernel; zeros where it does not provide them. Takes a few tens of microseconds.
ResidentMemory resident_memory();

/// Memory in use at one moment of a run.
struct MemorySample {
  double seconds = 0;  ///< since the start of the run
  ResidentMemory resident;
  std::array<int64_t, static_cast<size_t>(MemoryTag::kCount)> tags{};  ///< bytes in use by ledger tag

  int64_t tagged() const;  ///< all tags together
};

}  // namespace pelage
