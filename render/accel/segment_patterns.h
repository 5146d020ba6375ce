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

/// Provides index arrays for Embree: the index of the first control point of each segment. Supports batches
/// in which all strands have the same number of points. Batches with the same number of points per strand
/// share one array, because it does not depend on the strands themselves. Thread safety: all members may be
/// called from any thread.
class SegmentPatterns {
 public:
  struct Pattern {
    /// Index of the first control point of each segment, strand by strand.
    std::vector<uint32_t> first_vertex;
    MemoryCharge charge;
  };

  explicit SegmentPatterns(MemoryLedger& ledger) : ledger_(ledger) {}

  /// Charges in advance the memory that get() needs for batches of up to `strands` strands with `segments`
  /// segments each. get() then charges nothing for such batches. Call this for all batches before the first
  /// get().
  void expect(size_t segments, size_t strands);
  /// Returns the array for at least `strands` strands of `segments` segments each. In the array of control
  /// points, consecutive strands begin `stride` points apart.
  std::shared_ptr<const Pattern> get(uint32_t segments, uint32_t stride, size_t strands);

 private:
  struct Expected {
    size_t strands = 0;
    MemoryCharge charge;
  };

  MemoryLedger& ledger_;
  std::mutex mutex_;                     // guards the following
  std::map<size_t, Expected> expected_;  // by segments per strand
  std::map<std::pair<uint32_t, uint32_t>, std::shared_ptr<const Pattern>> patterns_;
};

}  // namespace pelage
