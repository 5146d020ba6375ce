// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace pelage {

/// Counts of the work of a Residency. Add up only the counts of residencies that existed one after the other.
struct ResidencyCounts {
  int64_t expansions = 0;    ///< units grown
  int64_t reexpansions = 0;  ///< units grown again, because their slot had been evicted
  int64_t evictions = 0;
  int64_t touched = 0;            ///< distinct slots that were grown
  int64_t false_expansions = 0;   ///< units evicted, or held now, without a mark_hit()
  int64_t working_set_bytes = 0;  ///< of all distinct slots ever grown; a sum of counts keeps the largest
  int64_t peak_bytes = 0;         ///< max held at once, including reservations
  int64_t overruns = 0;           ///< units larger than their reservation: a bug of the grower
  double waited_s = 0;            ///< time asleep waiting for others, summed over threads
  double cpu_s = 0;               ///< CPU time of growing, evicting and freeing units, of all threads

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
