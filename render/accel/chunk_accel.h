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
  AccelKind kind = AccelKind::kEmbree;  ///< of flat strands; round ones and skins are Embree's
  EmbreeChunkOptions chunk;
  FurChunkOptions fur;
  bool eager = false;         ///< everything is grown before the first ray
  bool opaque = false;        ///< every strand is known to be opaque
  uint64_t memory_limit = 0;  ///< bytes that the ledger's budgeted tags may reach; 0 = no limit
  int threads = 1;            ///< TraceThread::worker is below it
  /// Where chunks of fur are read instead of being grown, unless all are grown before the first ray; or null.
  /// What is damaged there is grown.
  std::shared_ptr<const FurChunkFile> file = {};
};

/// Accel over geometry that exists only while something needs it. Three parts: a ChunkTree says which chunks
/// a ray may meet, a Residency grows and drops them, and a ChunkGeometry is what one of them holds.
///
/// A ray visits the chunks that are resident first, front to back, and then those that it still reaches of
/// the others; each at most once. A chunk that is not resident grows only for a ray that meets one of its
/// fine boxes, where it has any, before what the ray has met so far. What a ray meets is copied out while the
/// chunk is pinned. Neither the budget nor the boxes, as long as they hold their chunks, nor what is resident
/// reaches a result.
///
/// Errors of a grower pass through closest() and transmittance().
/// Thread safety: as Accel; each TraceThread::worker is used by one thread at a time.
class ChunkAccel final : public Accel {
 public:
  /// `bounds`: one per chunk, over the whole shutter; what they say is not read with `eager`, where boxes are
  /// measured on what was grown. Grower and `progress`, which is told of chunks of the file that are damaged,
  /// outlive the accelerator. When `progress` is cancelled meanwhile, the accelerator is not to be used.
  /// Throws Error: kMemory when the limit is too small, and what the grower throws where all is grown.
  ChunkAccel(std::vector<ChunkBounds> bounds, const ChunkGrower& grower, const ChunkAccelOptions& options,
             const Job& job);
  ~ChunkAccel() override;

  Hit closest(const Ray& ray, TraceThread& thread) const override;
  float transmittance(const Ray& ray, TraceThread& thread) const override;
  bool opaque() const override { return options_.opaque; }
  Box3f bounds() const override { return tree_->bounds(); }

  /// Whether the memory limit held all chunks together when the accelerator was made.
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
  std::vector<uint32_t> given_parts_;   // boxes of each chunk in the tree
  std::unique_ptr<Scratch[]> scratch_;  // one per thread
  std::vector<MemoryCharge> charges_;
  bool fits_ = true;
};

}  // namespace pelage
