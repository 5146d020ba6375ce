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

/// The first of two passes (bound_chunks): boxes of chunks that are grown once for that, in this run or in
/// one before. Call read(), then measure(), then what they found. What a file system refuses to keep is told
/// of once.
class MeasuredBounds {
 public:
  MeasuredBounds(const BoundingOptions& options, std::span<const Procedural* const> chunks,
                 const WarningSink& warn);

  /// Takes what side files remember.
  void read(const Job& job);
  /// Measures the rest, and writes each side file when the last of its chunks is known.
  void measure(const Job& job);

  BoundingCounts counts() const;
  std::vector<ChunkBounds> bounds() && { return std::move(bounds_); }

 private:
  static constexpr uint32_t kNone = ~0u;
  /// Chunks whose boxes are remembered in one file: all that the file is about.
  struct BoundsGroup {
    BoundsRecord record;
    std::vector<uint32_t> chunks;  // by index in the file; kNone where a chunk is not among those bounded
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
  const WarningSink warn_;  // by one thread at a time
  std::mutex warning_;
  bool warned_ = false;  // that something cannot be kept; guarded by warning_
  std::vector<ChunkBounds> bounds_;
  std::vector<BoundsArea> areas_;  // by chunk, so that their sum is the same for any order
  std::vector<BoundsGroup> groups_;
  std::vector<uint32_t> group_of_;           // by chunk; kNone: of none that is complete
  std::vector<std::atomic<uint32_t>> left_;  // by family: chunks that are not known yet
  std::vector<char> known_;                  // by chunk: from a file
};

}  // namespace pelage
