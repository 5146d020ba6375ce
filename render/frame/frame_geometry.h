// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "base/job.h"
#include "render/accel/chunk_accel.h"
#include "render/frame/frame_chunks.h"
#include "render/frame/frame_statistics.h"

namespace pelage {

/// The geometry of a frame: chunks, the boxes around them, and the accelerator. Chunks are grown when a ray
/// needs them, unless the scene requests everything up front.
class FrameGeometry {
 public:
  /// Splits all procedurals and bounds their leaves. Throws Error; kMemory when `render.memory` does not hold
  /// the largest chunk. Returns null when cancelled.
  static std::unique_ptr<const FrameGeometry> make(const RenderScene& scene, const Job& job,
                                                   FrameStatistics& statistics);

  const Accel& accel() const { return accel_; }
  /// The same chunks, for callers that need strands and boxes.
  const ResidentChunks& chunks() const { return accel_.chunks(); }
  /// Whether all chunks together fit the budget, so that none is ever evicted.
  bool fits() const { return chunks().fits(); }
  /// CPU seconds spent on growing and evicting chunks so far.
  double growth_cpu_s() const { return chunks().counts().cpu_s; }
  /// Adds the numbers of units grown, evicted and tested.
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
