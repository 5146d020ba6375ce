// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "procedurals/bounds/chunk_bounds.h"
#include "render/accel/chunk_grower.h"
#include "render/accel/chunk_tree.h"
#include "render/accel/part_bounds.h"

namespace pelage {

class Workers;

/// The known boxes of the chunks of a frame: the boxes given before any chunk was grown, and the boxes
/// measured when a chunk was first grown.
///
/// Thread safety: any thread may call const members and learn() at any time, but concurrent calls of learn()
/// must be for different chunks. build_tree() and build_tree_of_learned() must not run concurrently with any
/// other member.
class ChunkBoxes {
 public:
  /// `given`: the boxes of each chunk, over the whole shutter. `fur_trees`: whether fur chunks are traced by
  /// fur trees. If so, the boxes of a fur chunk are enlarged by the max displacement that snapping to the
  /// grid causes (FurGrid::margin()), and then merged into one box. One box suffices, because tracing the
  /// tree of a resident chunk costs less than testing the boxes of the chunk's parts.
  ChunkBoxes(std::vector<ChunkBounds> given, const ChunkGrower& grower, bool fur_trees);
  ~ChunkBoxes();
  ChunkBoxes(const ChunkBoxes&) = delete;
  ChunkBoxes& operator=(const ChunkBoxes&) = delete;

  /// Builds the tree over the given boxes.
  void build_tree(const Workers& workers);
  /// Builds the tree again, with the measured boxes of those chunks of fur that were grown so far. Does
  /// nothing if all these boxes are in the tree. All given boxes must be constant in time, one per chunk.
  void tighten(const Workers& workers);
  /// Builds the tree over the measured boxes. Call learn() for every chunk first.
  void build_tree_of_learned(const Workers& workers);

  size_t size() const { return known_.size(); }
  /// Returns the tree, or null before it is built.
  const ChunkTree* tree() const { return tree_.get(); }
  /// Box that contains the whole chunk at all times of the shutter, in world space; empty for an empty chunk.
  /// The tree must have been built.
  const Box3f& whole(uint32_t chunk) const { return whole_[chunk]; }
  /// Number of the chunk's boxes in the tree.
  size_t parts_in_tree(uint32_t chunk) const { return tree_parts_[chunk]; }

  bool in_fur_tree(uint32_t chunk) const { return known_[chunk].in_fur_tree; }
  bool has_cell_bounds(uint32_t chunk) const { return cell_bounds(chunk).count() > 0; }
  const SegmentCellBounds& cell_bounds(uint32_t chunk) const { return known_[chunk].cell_bounds; }
  /// Distance by which a query must enlarge the chunk's cell bounds on every side.
  float margin(uint32_t chunk) const { return known_[chunk].margin; }

  /// Whether boxes measured on the chunk may be tighter than the given boxes.
  bool may_learn(uint32_t chunk) const { return known_[chunk].learns; }
  /// The measured boxes; null before the chunk is first grown, and always if may_learn() is false.
  const PartBoxes* learned(uint32_t chunk) const { return learned_[chunk].load(std::memory_order_acquire); }
  /// Stores measured boxes. Call at most once per chunk.
  void learn(uint32_t chunk, const ChunkBounds& measured);
  /// Stores boxes that were measured on the same chunk in another frame.
  void learn(uint32_t chunk, std::unique_ptr<const PartBoxes> measured);
  /// Number of boxes to measure on a chunk with `primitives` segments or triangles.
  static size_t learned_parts(size_t primitives);
  static constexpr size_t kPrimitivesPerPart = 1024, kMaxParts = 64;

  /// Removes the boxes of a chunk of fur, for another frame: the given box, or the measured one if there are
  /// no cell bounds. Returns no boxes if they are not known any more, because they were linear in time or in
  /// several parts. The chunk then has no known boxes: call only before this object is destroyed.
  ChunkBounds take_given(uint32_t chunk);
  /// Removes the measured boxes; null if there are none. Call only before this object is destroyed.
  std::unique_ptr<const PartBoxes> take_learned(uint32_t chunk);

  /// Upper bound of the memory in bytes, without the tree but with all boxes that may be learned.
  size_t bytes_bound() const { return bytes_bound_; }

 private:
  struct KnownBounds {
    SegmentCellBounds cell_bounds;
    Box3f given;  // before it was enlarged by the margin; only of chunks in fur trees with a constant box
    float margin = 0;
    bool learns = true;
    bool in_fur_tree = false;
  };

  Box3f tight_box(uint32_t chunk) const;

  std::vector<ChunkBounds> given_;  // empty once the tree is built
  std::vector<KnownBounds> known_;
  std::vector<std::atomic<const PartBoxes*>> learned_;
  std::vector<Box3f> whole_;
  std::vector<uint32_t> tree_parts_;
  std::unique_ptr<const ChunkTree> tree_;
  std::atomic<bool> has_news_{false};  // boxes were measured since the tree was built
  size_t bytes_bound_ = 0;
};

}  // namespace pelage
