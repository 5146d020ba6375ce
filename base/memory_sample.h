// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "base/ledger.h"

namespace pelage {

/// Resident pages of this process, in bytes.
struct ResidentMemory {
  int64_t anonymous = 0;  ///< heap, stacks and other private pages; a MemoryLedger counts only such memory
  int64_t file = 0;       ///< pages of mapped files: the program itself, libraries, caches
};

/// Reads the current values from the kernel; zeros where the kernel does not report them. Takes a few tens of
/// microseconds.
ResidentMemory resident_memory();

/// Memory in use at one moment of a run.
struct MemorySample {
  double seconds = 0;  ///< time of the sample, since the start of the run
  ResidentMemory resident;
  std::array<int64_t, static_cast<size_t>(MemoryTag::kCount)> tags{};  ///< bytes in use by ledger tag

  int64_t tagged() const;  ///< sum of `tags`
};

}  // namespace pelage
