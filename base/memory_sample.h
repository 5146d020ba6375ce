// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "base/ledger.h"

namespace pelage {

/// Pages of this process that are in memory, in bytes.
struct ResidentMemory {
  int64_t anonymous = 0;  ///< heap, stacks and other private pages: what a ledger can explain
  int64_t file = 0;       ///< pages of mapped files: the program itself, libraries, caches
};

/// As the kernel counts them now; zeros where it does not say. A few tens of microseconds.
ResidentMemory resident_memory();

/// What was in memory at one moment of a run.
struct MemorySample {
  double seconds = 0;  ///< since the run began
  ResidentMemory resident;
  std::array<int64_t, static_cast<size_t>(MemoryTag::kCount)> tags{};  ///< bytes in use by ledger tag

  int64_t tagged() const;  ///< all tags together
};

}  // namespace pelage
