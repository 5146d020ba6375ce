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

namespace pelage {

struct ResidentChunksOptions {
  AccelKind kind = AccelKind::kEmbree;  ///< for flat strands; round ones and skins always use Embree
  EmbreeChunkOptions chunk;
  FurChunkOptions fur;
  bool eager = false;         ///< everything is grown before the first visit
  bool opaque = false;        ///< every strand is known to be opaque
  uint64_t memory_limit = 0;  ///< max bytes of the ledger's budgeted tags; 0 = no limit
  int threads = 1;            ///< workers that visit are below it
  /// Where chunks of fur are read instead of being grown, unless all are grown before the first visit; or
  /// null. What is damaged there is grown.
  std::shared_ptr<const FurChunkFile> file = {};
};

/// The chunks of a frame. Each is grown when somebody visits it, dropped when the memory limit needs its
/// room, and grown again; neither the limit nor what is resident reaches what a visit sees. Rays go through
/// them by ChunkAccel; who wants strands and not rays visits one chunk after the other.
///
/// Between what strands and skins are made by (Procedural, DeferredSkin) and what keeps them (Residency)
/// there are two classes. A ChunkGrower, in a frame FrameChunks, knows the scene: it numbers the chunks and
/// makes the plain contents of one. This one knows no scene: it makes of contents what rays are traced with,
/// says what that takes, and remembers their boxes.
///
/// Thread safety: const members from any thread; each number `worker` is used by one thread at a time. The
/// others before. What a grower throws passes through visit().
class ResidentChunks final : private Grower {
 public:
  /// `bounds`: one per chunk, over the whole shutter; what they say is not read with `eager`, where boxes are
  /// measured on what was grown. Grower and `progress`, which is told of chunks of the file that are damaged,
  /// outlive this. When `progress` is cancelled meanwhile, nothing may be visited.
  /// Throws Error: kMemory when the limit is too small, and what the grower throws where all is grown.
  ResidentChunks(std::vector<ChunkBounds> bounds, const ChunkGrower& grower,
                 const ResidentChunksOptions& options, const Job& job);

  size_t size() const { return boxes_.size(); }
  bool is_skin(uint32_t chunk) const { return grower_.is_skin(chunk); }
  /// Which coat of which character, or which skin.
  uint32_t part(uint32_t chunk) const { return grower_.part(chunk); }
  bool opaque() const { return options_.opaque; }
  /// ChunkBoxes::whole() is what there is to sort chunks into buckets by, grown or not.
  const ChunkBoxes& boxes() const { return boxes_; }

  /// Calls use(const ChunkGeometry&), growing the chunk before if it is not resident, and returns a copy of
  /// what it returns. The chunk stays while `use` runs and may be gone afterwards. A worker is in one visit
  /// at a time: within `use` nothing is visited and no ray is traced, which is checked whatever the limit.
  template <class Use>
  auto visit(uint32_t chunk, int worker, Use&& use) const {
    return residency_->visit(chunk, worker, [&](Resident& unit) {
      return std::forward<Use>(use)(static_cast<const ChunkGeometry&>(unit));
    });
  }
  /// The strand of a handle: ChunkGeometry::strand() in a visit of its chunk.
  void copy_strand(StrandHandle handle, int worker, Strands& out) const {
    visit(handle.chunk, worker, [&](const ChunkGeometry& chunk) { chunk.strand(handle.index, out); });
  }
  /// A hint: it may change at once.
  bool is_resident(uint32_t chunk) const { return residency_->is_resident(chunk); }
  /// Growing the chunk was of use, for ResidencyCounts::false_expansions.
  void mark_hit(uint32_t chunk) const { residency_->mark_hit(chunk); }

  /// Whether the memory limit held all chunks together when this was made.
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
  void find_whether_all_fit(const MemoryLedger& ledger);

  PagePool pool_;  // for all trees
  const ChunkGrower& grower_;
  const ResidentChunksOptions options_;
  FurChunkOptions fur_;
  Progress& progress_;
  EmbreeDevice device_;
  SegmentPatterns patterns_;
  ChunkBoxes boxes_;
  std::vector<std::atomic<uint32_t>> build_pages_;  // what a tree needed when it was built, once it was
  std::vector<MemoryCharge> charges_;
  mutable std::optional<Residency> residency_;
  bool fits_ = true;
};

}  // namespace pelage
