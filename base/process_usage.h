// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/memory_sample.h"

namespace pelage {

/// Time and memory that a run of the program took, over all frames.
struct ProcessUsage {
  double wall_s = 0;
  double cpu_s = 0;
  int64_t peak_rss_bytes = 0;
  int64_t baseline_rss_bytes = 0;        ///< resident set when the command line had been parsed
  int64_t peak_anonymous_bytes = 0;      ///< highest resident anonymous memory that was sampled
  int64_t baseline_anonymous_bytes = 0;  ///< resident anonymous memory when the command line had been parsed
  int64_t unexplained_bytes = 0;         ///< anonymous peak - baseline - all ledger tags at the peak (law 5)
  std::map<std::string, int64_t> memory_bytes;  ///< peak by ledger tag
  std::vector<MemorySample> timeline;           ///< memory over time, if requested
};

/// Current and highest resident set of this process, in bytes; user + system CPU seconds so far, of the
/// process and of the calling thread.
int64_t current_rss_bytes();
int64_t peak_rss_bytes();
double cpu_seconds();
double thread_cpu_seconds();

}  // namespace pelage
