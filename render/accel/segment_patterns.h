// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "base/ledger.h"

namespace pelage {

/// First control points of segments, for batches whose strands all have the same number of points. Such
/// batches share one array, which does not depend on the strands. Thread safety: any thread.
class SegmentPatterns {
 public:
  struct Pattern {
    std::vector<uint32_t> first_vertex;  ///< first control point of each segment of each strand
    MemoryCharge charge;
  };

  explicit SegmentPatterns(MemoryLedger& ledger) : ledger_(ledger) {}

  /// Charges the memory that get() may need for batches with this number of strands, so that get() charges
  /// nothing later. Call for all batches before the first get().
  void expect(size_t segments, size_t strands);
  /// Returns the array for at least `strands` strands of `segments` segments each. The first control points
  /// of consecutive strands are `stride` apart.
  std::shared_ptr<const Pattern> get(uint32_t segments, uint32_t stride, size_t strands);

 private:
  struct Expected {
    size_t strands = 0;
    MemoryCharge charge;
  };

  MemoryLedger& ledger_;
  std::mutex mutex_;                     // guards the following
  std::map<size_t, Expected> expected_;  // by segments
  std::map<std::pair<uint32_t, uint32_t>, std::shared_ptr<const Pattern>> patterns_;
};

}  // namespace pelage
