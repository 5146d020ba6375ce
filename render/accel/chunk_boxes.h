// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "procedurals/chunk_bounds.h"
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
  /// Builds the tree over the measured boxes. Call learn() for every chunk first.
  void build_tree_of_learned(const Workers& workers);

  size_t size() const { return known_.size(); }
  /// Returns the tree, or null before it is built.
  const ChunkTree* tree() const { return tree_.get(); }
  /// Box that contains the whole chunk at all times of the shutter, in world space; empty for an empty chunk.
  /// The tree must have been built. (With `bounds: user`, the user chose the box, and it may be too large or
  /// too small.)
  const Box3f& whole(uint32_t chunk) const { return whole_[chunk]; }
  /// Number of the chunk's boxes in the tree.
  size_t parts_in_tree(uint32_t chunk) const { return tree_parts_[chunk]; }

  bool in_fur_tree(uint32_t chunk) const { return known_[chunk].in_fur_tree; }
  bool has_fine(uint32_t chunk) const { return fine(chunk).count() > 0; }
  const FineBoxes& fine(uint32_t chunk) const { return known_[chunk].fine; }
  /// Distance by which a query must enlarge the chunk's fine boxes on every side.
  float margin(uint32_t chunk) const { return known_[chunk].margin; }

  /// Whether boxes measured on the chunk may be tighter than the given boxes.
  bool may_learn(uint32_t chunk) const { return known_[chunk].learns; }
  /// The measured boxes; null before the chunk is first grown, and always if may_learn() is false.
  const PartBoxes* learned(uint32_t chunk) const { return learned_[chunk].load(std::memory_order_acquire); }
  /// Stores measured boxes. Call at most once per chunk.
  void learn(uint32_t chunk, const ChunkBounds& measured);
  /// Number of boxes to measure on a chunk with `primitives` segments or triangles.
  static size_t learned_parts(size_t primitives);
  static constexpr size_t kPrimitivesPerPart = 1024, kMaxParts = 64;

  /// Upper bound of the memory in bytes, without the tree but with all boxes that may be learned.
  size_t bytes_bound() const { return bytes_bound_; }

 private:
  struct KnownBounds {
    FineBoxes fine;
    float margin = 0;
    bool learns = true;
    bool in_fur_tree = false;
  };

  std::vector<ChunkBounds> given_;  // empty once the tree is built
  std::vector<KnownBounds> known_;
  std::vector<std::atomic<const PartBoxes*>> learned_;
  std::vector<Box3f> whole_;
  std::vector<uint32_t> tree_parts_;
  std::unique_ptr<const ChunkTree> tree_;
  size_t bytes_bound_ = 0;
};

}  // namespace pelage
