// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "base/content_store.h"
#include "render/accel/fur_chunk.h"

namespace pelage {

/// The fur of a frame on disk, chunk by chunk: an entry of kind "fur-chunks" of a content store. A chunk is
/// four sections, each with a checksum: what is known of it, the packed strands, nodes, leaves. They are read
/// and checked when the chunk is needed, straight to where they stay; nothing is mapped. A chunk that is not
/// what was written is lost, the others are not.
///
/// Thread safety: const members may be called from any thread.
class FurChunkFile {
 public:
  /// Counts up whenever the same strands would give other bytes.
  static constexpr uint32_t kVersion = 2;

  /// Writes an entry, chunk by chunk, in order; it exists from commit() on.
  class Writer {
   public:
    Writer(const ContentStore& store, const ContentHash& key);
    /// `chunk` may be null: one that is no fur.
    void add(const FurChunk* chunk);
    /// Whether nothing more can come of it.
    bool failed() const { return entry_.failed(); }
    /// Whether the entry now exists; what the file system refuses is told to `warn`.
    bool commit(const WarningSink& warn);

   private:
    ContentStore::Writer entry_;
  };

  /// Nothing when there is no such entry, or one that is damaged or foreign as far as its table tells: then
  /// `warn` has been told.
  static std::unique_ptr<const FurChunkFile> open(const ContentStore& store, const ContentHash& key,
                                                  size_t chunk_count, const WarningSink& warn);
  explicit FurChunkFile(StoredSections file);

  size_t chunk_count() const { return file_.section_count() / kSections; }
  /// Of any chunk of the frame: those behind the last are no fur. No longer of one that is lost.
  bool has(uint32_t chunk) const {
    return chunk < chunk_count() && file_.section_bytes(kSections * size_t(chunk)) > 0 &&
           !lost_[chunk].load(std::memory_order_relaxed);
  }
  /// At least what reading a chunk holds at any moment, and what the chunk holds afterwards.
  size_t bytes_bound(uint32_t chunk) const;
  /// `pool` as FurTreeOptions. Null when the chunk cannot be read or is not what was written: then it is
  /// lost, the file is removed, so that it will be made again, or `warn` is told why it cannot be; it is told
  /// once for all chunks.
  std::unique_ptr<FurChunk> read(uint32_t chunk, const WarningSink& warn, PagePool* pool = nullptr) const;

  /// What this object holds.
  size_t bytes() const { return sizeof(*this) + file_.bytes() + chunk_count() * sizeof(lost_[0]); }
  StoredReads reads() const {
    return {chunks_read_.load(std::memory_order_relaxed), bytes_read_.load(std::memory_order_relaxed)};
  }

 private:
  static constexpr size_t kSections = 4;

  /// Throws Error (kInput) when it cannot be read or is not what was written.
  std::unique_ptr<FurChunk> parse(uint32_t chunk, PagePool* pool) const;

  StoredSections file_;
  std::unique_ptr<std::atomic<bool>[]> lost_;  // by chunk
  mutable std::atomic<bool> is_damaged_{false};
  mutable std::atomic<int64_t> chunks_read_{0}, bytes_read_{0};
};

}  // namespace pelage
