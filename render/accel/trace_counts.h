// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pelage {

/// Cost of tracing.
struct TraceCounts {
  int64_t box_tests = 0;      ///< rays against boxes above the chunks
  int64_t chunk_visits = 0;   ///< rays against the contents of chunks
  int64_t absent_visits = 0;  ///< of these, of chunks that were not resident shortly before

  TraceCounts& operator+=(const TraceCounts& other) {
    box_tests += other.box_tests;
    chunk_visits += other.chunk_visits;
    absent_visits += other.absent_visits;
    return *this;
  }
};

/// Chunks that were read from a file instead of grown.
struct StoredReads {
  int64_t chunks = 0, bytes = 0;

  StoredReads& operator+=(const StoredReads& other) {
    chunks += other.chunks;
    bytes += other.bytes;
    return *this;
  }
};

}  // namespace pelage
