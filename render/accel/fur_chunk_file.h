// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "base/content_store.h"
#include "render/accel/fur_chunk.h"

namespace pelage {

/// The fur of a frame on disk, chunk by chunk: an entry of kind "fur-chunks" in a content store. A chunk has
/// four sections, each with its own checksum: metadata, packed strands, nodes, leaves. They are read and
/// verified when the chunk is needed, directly into their final memory; nothing is mapped. A damaged chunk is
/// lost without affecting the others.
///
/// Thread safety: const members may be called from any thread.
class FurChunkFile {
 public:
  /// Incremented whenever the same strands would give different bytes.
  static constexpr uint32_t kVersion = 2;

  /// Writes an entry, chunk by chunk, in order; it exists after commit().
  class Writer {
   public:
    Writer(const ContentStore& store, const ContentHash& key);
    /// `chunk` may be null: not fur.
    void add(const FurChunk* chunk);
    /// Whether writing has failed.
    bool failed() const { return entry_.failed(); }
    /// Returns whether the entry now exists; reports file system errors to `warn`.
    bool commit(const WarningSink& warn);

   private:
    ContentStore::Writer entry_;
  };

  /// Returns null if the entry is missing, or if its table shows that it is damaged or foreign. Calls `warn`
  /// for a damaged or foreign entry.
  static std::unique_ptr<const FurChunkFile> open(const ContentStore& store, const ContentHash& key,
                                                  size_t chunk_count, const WarningSink& warn);
  explicit FurChunkFile(StoredSections file);

  size_t chunk_count() const { return file_.section_count() / kSections; }
  /// Whether the file has this chunk of the frame; chunks after the last are not fur. False for lost chunks.
  bool has(uint32_t chunk) const {
    return chunk < chunk_count() && file_.section_bytes(kSections * size_t(chunk)) > 0 &&
           !lost_[chunk].load(std::memory_order_relaxed);
  }
  /// Upper bound of the memory that a chunk holds, both while it is read and afterwards.
  size_t bytes_bound(uint32_t chunk) const;
  /// `pool` as in FurTreeOptions. Returns null when the chunk cannot be read or is damaged. The chunk is then
  /// lost, and the file is removed so that the next run makes it again. Calls `warn` once per file.
  std::unique_ptr<FurChunk> read(uint32_t chunk, const WarningSink& warn, PagePool* pool = nullptr) const;

  /// Memory of this object.
  size_t bytes() const { return sizeof(*this) + file_.bytes() + chunk_count() * sizeof(lost_[0]); }
  StoredReads reads() const {
    return {chunks_read_.load(std::memory_order_relaxed), bytes_read_.load(std::memory_order_relaxed)};
  }

 private:
  static constexpr size_t kSections = 4;

  /// Throws Error (kInput) when it cannot be read or is damaged.
  std::unique_ptr<FurChunk> parse(uint32_t chunk, PagePool* pool) const;

  StoredSections file_;
  std::unique_ptr<std::atomic<bool>[]> lost_;  // by chunk
  mutable std::atomic<bool> is_damaged_{false};
  mutable std::atomic<int64_t> chunks_read_{0}, bytes_read_{0};
};

}  // namespace pelage
