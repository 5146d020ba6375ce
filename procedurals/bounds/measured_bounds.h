// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "base/content_store.h"
#include "procedurals/bounds/bounding.h"

namespace pelage {

/// Determines the boxes of chunks for bound_chunks(), for strategies that measure strands. The boxes of a
/// chunk are read from a side file that an earlier run wrote; otherwise the chunk is grown and measured. Call
/// read(), then lock(), then measure(), then use the results. Warns only once if side files cannot be
/// written.
class MeasuredBounds {
 public:
  MeasuredBounds(const BoundingOptions& options, std::span<const Procedural* const> chunks,
                 const WarningSink& warn);

  /// Reads the boxes of all chunks for which earlier runs wrote side files.
  void read(const Job& job);
  /// Waits while another process measures the same boxes; then reads the side files that it wrote. Returns a
  /// lock if side files were missing: keep it during measure(), so that other processes wait for this
  /// one. A process waits only for one that misses the same files, as the regions of a frame do.
  std::optional<ContentStore::Lock> lock(const Job& job);
  /// Grows and measures the other chunks. Writes each side file as soon as the boxes of all its chunks are
  /// known. Writes a file only if all chunks that belong in it are among `chunks`.
  void measure(const Job& job);

  BoundingCounts counts() const;
  /// Returns the boxes of all chunks, in the order of `chunks`.
  std::vector<ChunkBounds> bounds() && { return std::move(bounds_); }

 private:
  static constexpr uint32_t kNone = ~0u;
  /// The chunks whose boxes are stored in one file.
  struct BoundsGroup {
    BoundsRecord record;
    std::vector<uint32_t> chunks;  // by index in the file; kNone: the chunk is not in chunks_
    bool is_complete() const;
  };

  void find_groups();
  bool is_known(const BoundsGroup& group) const;
  void read(const Job& job, const WarningSink& warn);
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
  bool warned_ = false;  // whether it warned that a file cannot be written; guarded by warning_
  std::vector<ChunkBounds> bounds_;
  std::vector<BoundsArea> areas_;  // by chunk, so that their sum does not depend on the order
  std::vector<BoundsGroup> groups_;
  std::vector<uint32_t> group_of_;           // by chunk; kNone: in no complete group
  std::vector<std::atomic<uint32_t>> left_;  // by group: count of chunks whose boxes are not known yet
  std::vector<char> known_;                  // by chunk: whether its boxes were read from a file
};

}  // namespace pelage
