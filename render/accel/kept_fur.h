// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "base/ledger.h"
#include "base/page_pool.h"
#include "procedurals/bounds/chunk_bounds.h"
#include "render/accel/fur_chunk.h"
#include "render/accel/part_bounds.h"

namespace pelage {

/// A chunk of fur between two frames: all that ResidentChunks knows about the chunk.
struct KeptChunk {
  MemoryCharge charge;            ///< of the memory of `fur`
  std::unique_ptr<FurChunk> fur;  ///< null if the chunk was not in memory
  ChunkBounds bounds;             ///< the boxes that were given before the chunk was grown
  std::unique_ptr<const PartBoxes>
      learned;         ///< the boxes measured when the chunk was grown; null if none were
  bool grown = false;  ///< whether the chunk was ever grown
};

/// The chunks of fur of an earlier frame, for a later frame. Each chunk is identified by the hash of
/// everything on which it depends. Not thread safe.
class KeptFur {
 public:
  /// Returns whether there was an earlier frame.
  bool has_frame() const { return has_frame_; }
  /// Replaces all chunks.
  void replace(std::vector<std::pair<ContentHash, KeptChunk>> chunks);
  void clear() { chunks_.clear(); }
  /// Frees the memory of the grown chunks. Their boxes stay.
  void free_chunks();

  /// Returns a chunk with this content; null if there is none.
  KeptChunk* find(const ContentHash& content);
  /// Returns the memory for the trees of chunks, which all frames share.
  const std::shared_ptr<PagePool>& pool() const { return pool_; }

 private:
  using Key = std::pair<uint64_t, uint64_t>;
  static Key key(const ContentHash& content) { return {content.low, content.high}; }

  std::shared_ptr<PagePool> pool_ = std::make_shared<PagePool>();  // before chunks_, which use its memory
  std::map<Key, KeptChunk> chunks_;
  bool has_frame_ = false;
};

}  // namespace pelage
