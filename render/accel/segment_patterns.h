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

/// First control points of segments, for batches whose strands all have equally many points. Such batches
/// share one array: it does not depend on the strands. Thread safety: any thread.
class SegmentPatterns {
 public:
  struct Pattern {
    std::vector<uint32_t> first_vertex;  ///< of each segment of each strand
    MemoryCharge charge;
  };

  explicit SegmentPatterns(MemoryLedger& ledger) : ledger_(ledger) {}

  /// For at least `strands` strands of `segments` segments each, whose first control points are `stride`
  /// apart. Kept as long as anybody holds it; what may be made for it is at most bytes_bound().
  std::shared_ptr<const Pattern> get(uint32_t segments, uint32_t stride, size_t strands);
  static size_t bytes_bound(size_t segments) { return 2 * segments * sizeof(uint32_t); }

 private:
  MemoryLedger& ledger_;
  std::mutex mutex_;  // guards patterns_
  std::map<std::pair<uint32_t, uint32_t>, std::shared_ptr<const Pattern>> patterns_;
};

}  // namespace pelage
