// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/job.h"
#include "base/page_pool.h"
#include "cache/residency.h"
#include "render/accel/chunk_boxes.h"
#include "render/accel/chunk_geometry.h"
#include "render/accel/chunk_grower.h"
#include "render/accel/embree_chunk.h"
#include "render/accel/fur_chunk.h"
#include "render/accel/fur_chunk_file.h"
#include "render/accel/kept_fur.h"

namespace pelage {

struct ResidentChunksOptions {
  AccelKind kind = AccelKind::kEmbree;  ///< accelerator for flat strands; round strands and skins always use
                                        ///< Embree
  EmbreeChunkOptions chunk;
  FurChunkOptions fur;
  bool eager = false;         ///< the constructor grows all chunks, and none is ever evicted
  bool opaque = false;        ///< every strand is known to be opaque
  uint64_t memory_limit = 0;  ///< max bytes of the ledger's budgeted tags; 0 = no limit
  int threads = 1;            ///< every `worker` passed to visit() is below this number
  /// File from which fur chunks are read instead of being grown; null: no file. Not used with `eager`. A
  /// damaged chunk is grown instead.
  std::shared_ptr<const FurChunkFile> file = {};
  /// Memory for the trees of fur chunks; null: the object makes its own.
  std::shared_ptr<PagePool> pool = {};
};

/// The chunks of a frame. A chunk is grown when it is visited, evicted when other chunks would otherwise
/// exceed the memory limit, and grown again at the next visit. A visit sees the same contents for every
/// limit, whichever chunks are resident. ChunkAccel traces rays through the chunks; code that needs strands
/// rather than rays visits one chunk after the other.
///
/// Procedural and DeferredSkin make strands and skins; Residency keeps them. Two classes connect these. A
/// ChunkGrower knows the scene: it numbers the chunks and makes the plain contents of each. (FrameChunks is
/// the ChunkGrower of a frame.) ResidentChunks does not know the scene: it turns contents into geometry that
/// rays are traced against, states how much memory this needs, and stores the boxes of the chunks.
///
/// Thread safety: const members from any thread, but a `worker` number may be used by only one thread at a
/// time. visit() passes on the exceptions of the grower.
class ResidentChunks final : private Grower {
 public:
  /// `kept`: chunks of an earlier frame with the same contents, by the number of the chunk in this frame.
  /// They are resident from the start, if the memory limit has room for them. Their `bounds` are not used.
  /// Empty if there are none; items without `fur` are not used either. Their trees must be in the memory of
  /// `options.pool`.
  ///
  /// `bounds`: the boxes of each chunk, over the whole shutter. With `eager`, only the length of `bounds` is
  /// used, because boxes are measured on the grown chunks. `grower` and `job.progress`, which receives
  /// warnings of damaged chunks in the file, must outlive this object. If `job.progress` is cancelled during
  /// construction, no chunk may be visited. Throws Error (kMemory) when the limit is too small. With `eager`,
  /// passes on exceptions of the grower.
  ResidentChunks(std::vector<ChunkBounds> bounds, const ChunkGrower& grower,
                 const ResidentChunksOptions& options, const Job& job, std::vector<KeptChunk> kept = {});

  /// ChunkBoxes::tighten(). No visit may be running.
  void tighten(const Job& job);

  /// Removes a chunk of fur and its boxes, for a later frame. Skins have no such chunks. KeptChunk::grown is
  /// not set. Call after the last visit and the last ray.
  KeptChunk release(uint32_t chunk, MemoryLedger& ledger);

  size_t size() const { return boxes_.size(); }
  bool is_skin(uint32_t chunk) const { return grower_.is_skin(chunk); }
  /// Index of the chunk's coat or skin in the frame.
  uint32_t part(uint32_t chunk) const { return grower_.part(chunk); }
  bool opaque() const { return options_.opaque; }
  /// Boxes of the chunks. ChunkBoxes::whole() is known even for chunks that were never grown; code that sorts
  /// chunks into buckets uses it.
  const ChunkBoxes& boxes() const { return boxes_; }

  /// Grows the chunk if it is not resident, calls use(const ChunkGeometry&), and returns the result of `use`
  /// by value. The chunk stays resident while `use` runs and may be evicted afterwards. A worker may make
  /// only one visit at a time: `use` must not visit a chunk or trace a ray. A check enforces this, with and
  /// without a memory limit.
  template <class Use>
  auto visit(uint32_t chunk, int worker, Use&& use) const {
    return residency_->visit(chunk, worker, [&](Resident& unit) {
      return std::forward<Use>(use)(static_cast<const ChunkGeometry&>(unit));
    });
  }
  /// Visits the chunk of a handle and copies the strand to `out`, as ChunkGeometry::strand() does.
  void copy_strand(StrandHandle handle, int worker, Strands& out) const {
    visit(handle.chunk, worker, [&](const ChunkGeometry& chunk) { chunk.strand(handle.index, out); });
  }
  /// A hint only: the answer may change at any time.
  bool is_resident(uint32_t chunk) const { return residency_->is_resident(chunk); }
  /// Records that growing the chunk was useful, for ResidencyCounts::false_expansions.
  void mark_hit(uint32_t chunk) const { residency_->mark_hit(chunk); }

  /// Whether all chunks together fitted into the memory limit when this object was constructed. Always true
  /// with `eager`.
  bool fits() const { return fits_; }
  ResidencyCounts counts() const { return residency_->counts(); }

 private:
  size_t reserve_bytes(uint32_t chunk) const override;
  std::string name(uint32_t chunk) const override { return grower_.name(chunk); }
  Grown grow(uint32_t chunk) override;
  std::unique_ptr<FurChunk> grow_fur(uint32_t chunk, ChunkContents contents, bool learns);
  bool is_stored(uint32_t chunk) const {
    return options_.file && !options_.eager && options_.file->has(chunk);
  }
  void expect_patterns();
  void adopt(std::vector<KeptChunk> kept, const MemoryLedger& ledger);
  MemoryCharge tree_charge(MemoryLedger& ledger) const;
  void find_whether_all_fit(const MemoryLedger& ledger);

  const ChunkGrower& grower_;
  const ResidentChunksOptions options_;
  std::shared_ptr<PagePool> pool_;  // memory of all fur trees
  FurChunkOptions fur_;
  Progress& progress_;
  EmbreeDevice device_;
  SegmentPatterns patterns_;
  ChunkBoxes boxes_;
  std::vector<std::atomic<uint32_t>> build_pages_;  // peak memory of each chunk's last build; 0: not built
  std::vector<MemoryCharge> charges_;
  MemoryCharge tree_charge_;
  mutable std::optional<Residency> residency_;
  bool fits_ = true;
};

}  // namespace pelage
