// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace pelage {

/// Counts of the work of a Residency. Do not add the counts of two Residencies that existed at the same time:
/// operator+= takes the max, not the sum, of working_set_bytes and peak_bytes.
struct ResidencyCounts {
  int64_t expansions = 0;    ///< growths of units, including reexpansions
  int64_t reexpansions = 0;  ///< growths of a unit that had been evicted
  int64_t evictions = 0;
  int64_t touched = 0;            ///< distinct slots whose unit was grown
  int64_t false_expansions = 0;   ///< growths of units without any mark_hit() while in memory
  int64_t working_set_bytes = 0;  ///< total memory of the units of all `touched` slots
  int64_t peak_bytes = 0;         ///< max memory held at once, including reservations
  int64_t overruns = 0;           ///< units larger than their reservation, which is a bug of the grower
  double waited_s = 0;            ///< seconds spent waiting for memory or other threads, summed over threads
  double cpu_s = 0;               ///< CPU seconds of growing, evicting and freeing units, of all threads

  ResidencyCounts& operator+=(const ResidencyCounts& other) {
    expansions += other.expansions;
    reexpansions += other.reexpansions;
    evictions += other.evictions;
    touched += other.touched;
    false_expansions += other.false_expansions;
    working_set_bytes = std::max(working_set_bytes, other.working_set_bytes);
    peak_bytes = std::max(peak_bytes, other.peak_bytes);
    overruns += other.overruns;
    waited_s += other.waited_s;
    cpu_s += other.cpu_s;
    return *this;
  }
};

}  // namespace pelage
