// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "procedurals/bounds/procedural.h"
#include "world/frame_coats.h"
#include "world/leaf_range.h"

namespace pelage {

/// The leaves of one coat in one frame as procedurals, with their exact boxes. Neighbouring leaves are close
/// to each other, so ranges of leaves form a tree: split() divides a range into up to eight ranges.
///
/// Thread safety: const members may be called from any thread.
class CoatTree {
 public:
  /// `lod`: level of detail of the coat; empty for all strands. Every leaf has the strands of the same leaf
  /// of the full coat that level of detail keeps.
  CoatTree(const FrameCoat& coat, const std::optional<Simplification>& lod);

  LeafRange all() const { return {0, leaves_.size()}; }
  std::vector<LeafRange> split(LeafRange range) const;
  /// Returns the exact box of a range over the shutter (law 4): empty if it has no strands. The first call
  /// measures all leaves, or reads their boxes from the side file beside the cache of the groom. `job` of
  /// that call must not run a loop at the same time.
  Box3f box(LeafRange range, const Job& job) const;
  const Procedural& leaf(size_t index) const { return *leaves_[index]; }
  /// Grows a leaf. Its strands have the attribute kRestPositions unless the skin is in its rest pose, because
  /// other renderers know no skin at rest.
  Strands grow(size_t index) const;
  /// Returns the memory that grow() takes, including the result, in bytes.
  int64_t growth_bytes(size_t index) const;

 private:
  std::vector<std::unique_ptr<Procedural>> leaves_;
  std::shared_ptr<const LimitSurface> rest_;  // null if the skin is in its rest pose
  mutable std::mutex mutex_;                  // guards the boxes; locked while they are measured
  mutable std::vector<Box3f> boxes_;
};

}  // namespace pelage
