// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/memory_sample.h"

namespace pelage {

/// Time and memory that one run of the program used, over all frames.
struct ProcessUsage {
  double wall_s = 0;
  double cpu_s = 0;                      ///< user + system time
  int64_t peak_rss_bytes = 0;            ///< max resident set
  int64_t baseline_rss_bytes = 0;        ///< resident set when the command line had been parsed
  int64_t peak_anonymous_bytes = 0;      ///< max resident anonymous memory of all samples
  int64_t baseline_anonymous_bytes = 0;  ///< resident anonymous memory when the command line had been parsed
  int64_t unexplained_bytes = 0;  ///< peak_anonymous_bytes - baseline_anonymous_bytes - sum of the ledger
                                  ///< tags in the sample of the peak (law 5)
  std::map<std::string, int64_t> memory_bytes;  ///< max bytes in use, by name of the ledger tag
  std::vector<MemorySample> timeline;           ///< memory over time, if requested
};

/// Current resident set of this process, in bytes.
int64_t current_rss_bytes();
/// Max resident set of this process so far, in bytes.
int64_t peak_rss_bytes();
/// CPU time of this process so far, user + system, in seconds.
double cpu_seconds();
/// CPU time of the calling thread so far, user + system, in seconds.
double thread_cpu_seconds();

}  // namespace pelage
