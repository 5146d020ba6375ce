// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pelage {

/// Counts of the work done by tracing rays.
struct TraceCounts {
  int64_t box_tests = 0;      ///< tests of one ray against one box above the chunks
  int64_t chunk_visits = 0;   ///< visits of one chunk's contents by one ray
  int64_t absent_visits = 0;  ///< visits of chunks that were not resident shortly before the visit

  TraceCounts& operator+=(const TraceCounts& other) {
    box_tests += other.box_tests;
    chunk_visits += other.chunk_visits;
    absent_visits += other.absent_visits;
    return *this;
  }
};

/// Number of chunks that were read from a file instead of grown, and number of bytes read.
struct StoredReads {
  int64_t chunks = 0, bytes = 0;

  StoredReads& operator+=(const StoredReads& other) {
    chunks += other.chunks;
    bytes += other.bytes;
    return *this;
  }
};

}  // namespace pelage
