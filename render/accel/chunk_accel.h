// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "base/job.h"
#include "procedurals/bounds/chunk_bounds.h"
#include "render/accel/accel.h"
#include "render/accel/chunk_grower.h"
#include "render/accel/chunk_tree.h"
#include "render/accel/resident_chunks.h"

namespace pelage {

/// Accel over chunks that are grown on demand and may be evicted. A ChunkTree finds the chunks that a ray may
/// hit, ResidentChunks grows and evicts chunks, and a ChunkGeometry is the content of one resident chunk.
///
/// A ray visits each chunk at most once: first the resident chunks, then the others that it can still hit. A
/// chunk that is not resident and has cell bounds is grown only for rays that intersect one of these boxes in
/// front of the nearest hit so far. The geometry that is hit is copied while the chunk is pinned. Results
/// depend neither on the memory limit, nor on which chunks are resident, nor on the boxes, provided that the
/// boxes contain their chunks.
///
/// closest(), transmittance() and strands_crossed() pass on the exceptions of the grower. Thread safety: as
/// Accel. A worker number (TraceThread::worker) may be used by one thread at a time, for one ray or one visit
/// of chunks() at a time.
class ChunkAccel final : public Accel {
 public:
  /// Takes the arguments of ResidentChunks and throws the same errors. Charges its own memory before it makes
  /// the ResidentChunks. The error for a memory limit that is too small therefore names a limit that
  /// suffices.
  ChunkAccel(std::vector<ChunkBounds> bounds, const ChunkGrower& grower, const ResidentChunksOptions& options,
             const Job& job, std::vector<KeptChunk> kept = {});
  ~ChunkAccel() override;

  Hit closest(const Ray& ray, TraceThread& thread) const override;
  float transmittance(const Ray& ray, TraceThread& thread) const override;
  StrandCount strands_crossed(const Ray& ray, uint32_t max, TraceThread& thread) const override;
  bool opaque() const override { return chunks_.opaque(); }
  Box3f bounds() const override { return chunks_.boxes().tree()->bounds(); }

  /// The chunks that rays are traced through.
  const ResidentChunks& chunks() const { return chunks_; }
  ResidentChunks& chunks() { return chunks_; }

 private:
  struct Scratch;
  template <class Far, class Visit>
  class Visits;

  /// Collects what a shadow ray crosses. Returns false when something blocks it.
  bool collect(const Ray& ray, TraceThread& thread, Crossings& crossings) const;
  template <class Far, class Visit>
  void visit_chunks(const Ray& ray, ChunkWalk::Order order, TraceThread& thread, const Far& far,
                    const Visit& visit) const;

  MemoryCharge scratch_charge_;
  std::unique_ptr<Scratch[]> scratch_;  // one per thread
  ResidentChunks chunks_;
};

}  // namespace pelage
