// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/job.h"
#include "cache/residency.h"
#include "procedurals/chunk_bounds.h"
#include "render/accel/accel.h"
#include "render/accel/chunk_grower.h"
#include "render/accel/chunk_tree.h"
#include "render/accel/embree_chunk.h"
#include "render/accel/fur_chunk.h"
#include "render/accel/fur_chunk_file.h"

namespace pelage {

struct ChunkAccelOptions {
  AccelKind kind = AccelKind::kEmbree;  ///< for flat strands; round ones and skins always use Embree
  EmbreeChunkOptions chunk;
  FurChunkOptions fur;
  bool eager = false;         ///< grow everything before the first ray
  bool opaque = false;        ///< every strand is known to be opaque
  uint64_t memory_limit = 0;  ///< max bytes of the ledger's budgeted tags; 0 = no limit
  int threads = 1;            ///< TraceThread::worker is less than this
  /// File from which chunks of fur are read instead of being grown, unless all are grown before the first
  /// ray; may be null. Damaged chunks are grown.
  std::shared_ptr<const FurChunkFile> file = {};
};

/// An Accel over geometry that exists only while something needs it. It has three parts: a ChunkTree finds
/// the chunks that a ray may hit, a Residency grows and evicts them, and a ChunkGeometry intersects the
/// contents of one chunk.
///
/// A ray visits the resident chunks first, front to back, then those of the others that it still reaches;
/// each at most once. A chunk that is not resident is grown only for rays that intersect one of its fine
/// boxes, if it has any, in front of the nearest hit so far. The geometry that is hit is copied while the
/// chunk is pinned. Results depend neither on the budget, nor on the boxes as long as they contain their
/// chunks, nor on what is resident.
///
/// Errors of the grower propagate through closest() and transmittance(). Thread safety: as Accel; each
/// TraceThread::worker is used by one thread at a time.
class ChunkAccel final : public Accel {
 public:
  /// `bounds`: one per chunk, over the whole shutter; their values are ignored with `eager`, which measures
  /// the grown contents. The grower and `progress`, which is warned of damaged chunks of the file, must
  /// outlive the accelerator. It must not be used when `progress` was cancelled meanwhile. Throws Error:
  /// kMemory when the limit is too small, and what the grower throws when everything is grown.
  ChunkAccel(std::vector<ChunkBounds> bounds, const ChunkGrower& grower, const ChunkAccelOptions& options,
             const Job& job);
  ~ChunkAccel() override;

  Hit closest(const Ray& ray, TraceThread& thread) const override;
  float transmittance(const Ray& ray, TraceThread& thread) const override;
  bool opaque() const override { return options_.opaque; }
  Box3f bounds() const override { return tree_->bounds(); }

  /// Whether the memory limit was sufficient for all chunks together when the accelerator was made.
  bool fits() const { return fits_; }
  ResidencyCounts counts() const { return residency_->counts(); }

 private:
  class Growth;
  struct Scratch;

  void build_tree(const std::vector<ChunkBounds>& bounds, const Job& job);
  template <class Far, class Visit>
  void visit_chunks(const Ray& ray, ChunkWalk::Order order, TraceThread& thread, const Far& far,
                    const Visit& visit) const;

  const ChunkAccelOptions options_;
  EmbreeDevice device_;
  SegmentPatterns patterns_;
  std::unique_ptr<Growth> growth_;
  std::unique_ptr<Residency> residency_;
  std::unique_ptr<ChunkTree> tree_;
  std::vector<uint32_t> given_parts_;   // number of boxes of each chunk in the tree
  std::unique_ptr<Scratch[]> scratch_;  // one per thread
  std::vector<MemoryCharge> charges_;
  bool fits_ = true;
};

}  // namespace pelage
