// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "base/job.h"
#include "render/accel/chunk_accel.h"
#include "render/frame/frame_chunks.h"
#include "render/frame/frame_statistics.h"

namespace pelage {

/// The geometry of a frame: chunks, the boxes around them, and the accelerator. A chunk is grown when a ray
/// needs it. With `render.bounds: none`, all chunks are grown up front instead.
class FrameGeometry {
 public:
  /// Splits all procedurals into leaves and computes the boxes of each leaf. Throws Error, of kind kMemory if
  /// the largest chunk does not fit `render.memory`. Returns null when cancelled. `statistics` receives the
  /// counts and times of these steps.
  static std::unique_ptr<const FrameGeometry> make(const RenderScene& scene, const Job& job,
                                                   FrameStatistics& statistics);

  const Accel& accel() const { return accel_; }
  /// Returns the chunks of accel(), for callers that need strands and boxes.
  const ResidentChunks& chunks() const { return accel_.chunks(); }
  /// Returns whether all chunks together fit `render.memory`, so that none is ever evicted.
  bool fits() const { return chunks().fits(); }
  /// Returns the CPU seconds spent on growing and evicting chunks so far.
  double growth_cpu_s() const { return chunks().counts().cpu_s; }
  // Of FrameChunks.
  int64_t strands_grown() const { return chunks_->strands_grown(); }
  int64_t strands_regrown() const { return chunks_->strands_regrown(); }
  /// Adds the counts of strands grown, of chunks grown and evicted, and of reads from `render.bvh.file`.
  void add_to(FrameStatistics& statistics) const;

 private:
  FrameGeometry(std::unique_ptr<const FrameChunks> chunks, std::vector<ChunkBounds> bounds,
                const ResidentChunksOptions& options, const Job& job);

  std::unique_ptr<const FrameChunks> chunks_;
  MemoryCharge chunks_charge_;
  std::shared_ptr<const FurChunkFile> stored_;
  MemoryCharge stored_charge_;
  ChunkAccel accel_;
};

}  // namespace pelage
