// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "base/content_store.h"
#include "render/accel/fur_chunk.h"

namespace pelage {

/// The fur of a frame in a file, chunk by chunk: an entry of kind "fur-chunks" in a content store. A chunk
/// has four sections, each with its own checksum: metadata, packed strands, nodes, leaves. read() reads and
/// verifies the sections of one chunk, directly into their final memory. The file is not memory-mapped. A
/// damaged chunk is lost, but the other chunks remain readable.
///
/// Thread safety: const members may be called from any thread.
class FurChunkFile {
 public:
  /// Version of the stored data. Must be incremented by every change that gives different bytes for the same
  /// strands.
  static constexpr uint32_t kVersion = 3;

  /// Writes an entry. Call add() for all chunks of the frame in ascending order. The entry exists only after
  /// commit() has returned true.
  class Writer {
   public:
    Writer(const ContentStore& store, const ContentHash& key);
    /// Adds the next chunk. Pass null for a chunk that is not fur. It is stored without data, like a chunk in
    /// which rays can hit hardly any segment.
    void add(const FurChunk* chunk);
    /// Whether writing has failed.
    bool failed() const { return entry_.failed(); }
    /// Finishes the entry. Returns whether the entry now exists. Reports file system errors to `warn`.
    bool commit(const WarningSink& warn);

   private:
    ContentStore::Writer entry_;
  };

  /// Opens the entry of a frame with `chunk_count` chunks. Returns null if the entry is missing. Also returns
  /// null, and calls `warn`, if the table of the file's sections shows that the file is damaged or is not
  /// such an entry.
  static std::unique_ptr<const FurChunkFile> open(const ContentStore& store, const ContentHash& key,
                                                  size_t chunk_count, const WarningSink& warn);
  explicit FurChunkFile(StoredSections file);

  size_t chunk_count() const { return file_.section_count() / kSections; }
  /// Whether the file has data of this chunk of the frame. False for chunks that were stored without data,
  /// for lost chunks, and for numbers from chunk_count() on (such chunks are not fur).
  bool has(uint32_t chunk) const {
    return chunk < chunk_count() && file_.section_bytes(kSections * size_t(chunk)) > 0 &&
           !lost_[chunk].load(std::memory_order_relaxed);
  }
  /// Upper bound of the bytes that a chunk holds in memory, both while it is read and afterwards.
  size_t bytes_bound(uint32_t chunk) const;
  /// Reads a chunk. `pool`: as in FurTreeOptions. Returns null when the chunk cannot be read or is damaged.
  /// In this case the chunk is lost, and the file is deleted so that the next run writes a new one. Calls
  /// `warn` only for the first lost chunk of the file.
  std::unique_ptr<FurChunk> read(uint32_t chunk, const WarningSink& warn, PagePool* pool = nullptr) const;

  /// Bytes of memory that this object holds.
  size_t bytes() const { return sizeof(*this) + file_.bytes() + chunk_count() * sizeof(lost_[0]); }
  StoredReads reads() const {
    return {chunks_read_.load(std::memory_order_relaxed), bytes_read_.load(std::memory_order_relaxed)};
  }

 private:
  static constexpr size_t kSections = 4;

  /// Reads and validates a chunk. Throws Error (kInput) when the chunk cannot be read or is damaged.
  std::unique_ptr<FurChunk> parse(uint32_t chunk, PagePool* pool) const;

  StoredSections file_;
  std::unique_ptr<std::atomic<bool>[]> lost_;  // by chunk
  mutable std::atomic<bool> is_damaged_{false};
  mutable std::atomic<int64_t> chunks_read_{0}, bytes_read_{0};
};

}  // namespace pelage
