// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "base/content_store.h"
#include "render/accel/fur_chunk.h"

namespace pelage {

class Workers;

/// The fur of a frame on disk, chunk by chunk: an entry of kind "fur-chunks" of a content store. A chunk is
/// four sections, each with a checksum: what is known of it, the packed strands, nodes, leaves. They are read
/// when the chunk is needed, straight to where they stay; nothing is mapped.
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
  /// Of any chunk of the frame: those behind the last are no fur.
  bool has(uint32_t chunk) const {
    return chunk < chunk_count() && file_.section_bytes(kSections * size_t(chunk)) > 0;
  }
  /// At least what reading a chunk holds at any moment, and what the chunk holds afterwards.
  size_t bytes_bound(uint32_t chunk) const;
  /// `pool` as FurTreeOptions. Throws Error (kInput) when it cannot be read or is not what was written.
  std::unique_ptr<FurChunk> read(uint32_t chunk, PagePool* pool = nullptr) const;
  /// Reads all chunks once. Whether they are what was written; otherwise `warn` has been told.
  bool check_all(const Workers& workers, const WarningSink& warn) const;

  /// What this object holds.
  size_t bytes() const { return sizeof(*this) + file_.bytes(); }
  int64_t chunks_read() const { return chunks_read_.load(std::memory_order_relaxed); }
  int64_t bytes_read() const { return bytes_read_.load(std::memory_order_relaxed); }

 private:
  static constexpr size_t kSections = 4;

  std::unique_ptr<FurChunk> parse(uint32_t chunk, PagePool* pool) const;

  StoredSections file_;
  mutable std::atomic<int64_t> chunks_read_{0}, bytes_read_{0};
};

}  // namespace pelage
