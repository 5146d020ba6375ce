// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "base/content_store.h"
#include "procedurals/bounding.h"

namespace pelage {

/// The first of two passes (bound_chunks): obtains the boxes of chunks by growing each chunk once and
/// measuring it, in this run or an earlier run. Call read(), then measure(), then use the results. Warns once
/// when side files cannot be written.
class MeasuredBounds {
 public:
  MeasuredBounds(const BoundingOptions& options, std::span<const Procedural* const> chunks,
                 const WarningSink& warn);

  /// Reads the boxes that earlier runs stored in side files.
  void read(const Job& job);
  /// Measures the other chunks, and writes each side file when all of its chunks are known.
  void measure(const Job& job);

  BoundingCounts counts() const;
  std::vector<ChunkBounds> bounds() && { return std::move(bounds_); }

 private:
  static constexpr uint32_t kNone = ~0u;
  /// The chunks whose boxes are stored in one file.
  struct BoundsGroup {
    BoundsRecord record;
    std::vector<uint32_t> chunks;  // by index in the file; kNone where a chunk is not being bounded
    bool is_complete() const;
  };

  void find_groups();
  void keep(uint32_t chunk, ChunkBounds bounds);
  void drop_parts(uint32_t chunk);
  void mark_known(uint32_t chunk);
  void write(const BoundsGroup& group);

  const BoundingOptions options_;
  const BoundSpan span_;
  const int keys_;
  const std::span<const Procedural* const> chunks_;
  const WarningSink warn_;  // called by one thread at a time
  std::mutex warning_;
  bool warned_ = false;  // that side files cannot be written; guarded by warning_
  std::vector<ChunkBounds> bounds_;
  std::vector<BoundsArea> areas_;  // by chunk, so that their sum does not depend on the order
  std::vector<BoundsGroup> groups_;
  std::vector<uint32_t> group_of_;           // by chunk; kNone: not in a complete group
  std::vector<std::atomic<uint32_t>> left_;  // by group: chunks that are not known yet
  std::vector<char> known_;                  // by chunk: read from a file
};

}  // namespace pelage
