// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/error.h"

namespace pelage {

/// The memory that a reader of strands may use. For use by one thread.
class ReadBudget {
 public:
  explicit ReadBudget(int64_t max_bytes) : max_bytes_(max_bytes) {}

  /// Adds `bytes` to the memory in use. Call it before the memory is allocated. Throws Error (kMemory) with
  /// `place` if the sum exceeds the limit.
  void charge(int64_t bytes, const SourcePosition& place);
  /// Subtracts bytes that were charged and are free again.
  void release(int64_t bytes) { used_bytes_ -= bytes; }

 private:
  const int64_t max_bytes_;
  int64_t used_bytes_ = 0;
};

}  // namespace pelage
