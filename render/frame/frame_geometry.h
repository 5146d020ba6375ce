// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/job.h"
#include "render/accel/chunk_accel.h"
#include "render/frame/frame_chunks.h"
#include "render/frame/frame_statistics.h"
#include "render/frame/skin_shadows.h"

namespace pelage {

/// The geometry of a frame: chunks, the boxes around them, and the accelerator. A chunk is grown when a ray
/// needs it. With `render.bounds: none`, or if FrameChunks::grow_at_once(), all chunks are grown up front
/// instead.
class FrameGeometry {
 public:
  /// Splits all procedurals into leaves and computes the boxes of each leaf. Throws Error, of kind kMemory if
  /// the largest chunk does not fit `render.memory`. Returns null when cancelled. `statistics` receives the
  /// counts and times of these steps.
  ///
  /// `kept`, if not null: chunks of an earlier frame. Those with the same contents are used instead of
  /// growing them again, and the others are freed. When cancelled, `kept` is unchanged. With `kept`, the time
  /// to the first picture matters most, so boxes come from FrameChunks::bound_quickly(). Call tighten() when
  /// many chunks have grown.
  static std::unique_ptr<FrameGeometry> make(const RenderScene& scene, const Job& job,
                                             FrameStatistics& statistics, KeptFur* kept = nullptr);
  /// Uses the measured boxes of chunks that have grown, so that later rays are faster. Affects no hit. No ray
  /// may be traced meanwhile.
  void tighten(const Job& job) {
    if (is_quick_) accel_.chunks().tighten(job);
  }
  /// Moves all chunks of fur to `kept`, which must be the object that was passed to make(). Afterwards, this
  /// object can only be destroyed. The scene may have changed since make().
  void release(KeptFur& kept, MemoryLedger& ledger);

  const Accel& accel() const { return accel_; }
  /// Returns the chunks of accel(), for callers that need strands and boxes.
  const ResidentChunks& chunks() const { return accel_.chunks(); }
  /// Returns the balls inside the skins of the scene. Computes them at the first call; not thread-safe.
  /// Throws the errors of SkinShadows.
  const SkinShadows& shadows(const RenderScene& scene, const Job& job) {
    if (!shadows_) shadows_ = std::make_unique<SkinShadows>(scene, job);
    return *shadows_;
  }
  /// Returns whether all chunks together fit `render.memory`, so that none is ever evicted.
  bool fits() const { return chunks().fits(); }
  /// Returns the CPU seconds spent on growing and evicting chunks so far.
  double growth_cpu_s() const { return chunks().counts().cpu_s; }
  // Of FrameChunks.
  int64_t strands_grown() const { return chunks_->strands_grown(); }
  int64_t strands_regrown() const { return chunks_->strands_regrown(); }
  /// Returns how often a chunk of fur was grown; 0 if it was kept from an earlier frame.
  uint32_t growths(uint32_t chunk) const { return chunks_->growths(chunk); }
  /// Adds the counts of strands grown, of chunks grown and evicted, and of reads from `render.bvh.file`.
  void add_to(FrameStatistics& statistics) const;

 private:
  FrameGeometry(std::unique_ptr<const FrameChunks> chunks, std::vector<ChunkBounds> bounds,
                const ResidentChunksOptions& options, const Job& job, std::vector<KeptChunk> kept);
  /// Returns the area of the boxes of all leaves.
  BoundsArea chunks_area() const;

  std::unique_ptr<const FrameChunks> chunks_;
  bool is_quick_ = false;                             // FrameChunks::bound_quickly()
  std::vector<std::optional<ContentHash>> contents_;  // by leaf; empty if chunks are not kept
  MemoryCharge chunks_charge_;
  std::shared_ptr<const FurChunkFile> stored_;
  MemoryCharge stored_charge_;
  ChunkAccel accel_;
  std::unique_ptr<SkinShadows> shadows_;  // null: not needed so far
};

}  // namespace pelage
