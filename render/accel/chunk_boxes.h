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

/// Where the chunks of a frame are, as far as that is known: the boxes that were given before anything was
/// grown, and those that were measured on a chunk when it was first grown.
///
/// Thread safety: const members from any thread, learn() from any thread for different chunks beside them;
/// the others before.
class ChunkBoxes {
 public:
  /// `given`: one per chunk, over the whole shutter. Of chunks that will stand in fur trees it widens the
  /// boxes by what snapping to a grid may add, and makes one of those of all parts: what a ray meets of a
  /// chunk that is resident, its tree tells at less cost than boxes above it.
  ChunkBoxes(std::vector<ChunkBounds> given, const ChunkGrower& grower, bool fur_trees);
  ~ChunkBoxes();
  ChunkBoxes(const ChunkBoxes&) = delete;
  ChunkBoxes& operator=(const ChunkBoxes&) = delete;

  /// Makes the tree over what was given.
  void build_tree(const Workers& workers);
  /// The same over what was learned, of all chunks.
  void build_tree_of_learned(const Workers& workers);

  size_t size() const { return known_.size(); }
  /// Null before it was built.
  const ChunkTree* tree() const { return tree_.get(); }
  /// Holds all of the chunk at all times of the shutter; world space; empty for a chunk of nothing. Once
  /// there is a tree. (With `bounds: user` as loose or as tight as the user wants it.)
  const Box3f& whole(uint32_t chunk) const { return whole_[chunk]; }
  /// Boxes of the chunk in the tree.
  size_t parts_in_tree(uint32_t chunk) const { return tree_parts_[chunk]; }

  bool in_fur_tree(uint32_t chunk) const { return known_[chunk].in_fur_tree; }
  bool has_fine(uint32_t chunk) const { return fine(chunk).count() > 0; }
  const FineBoxes& fine(uint32_t chunk) const { return known_[chunk].fine; }
  /// By how much fine boxes must be enlarged.
  float margin(uint32_t chunk) const { return known_[chunk].margin; }

  /// Whether measuring the chunk would tell more than is known of it.
  bool may_learn(uint32_t chunk) const { return known_[chunk].learns; }
  /// What was measured; null before the chunk was first grown, and where the fine boxes say as much.
  const PartBoxes* learned(uint32_t chunk) const { return learned_[chunk].load(std::memory_order_acquire); }
  /// Once for each chunk.
  void learn(uint32_t chunk, const ChunkBounds& measured);
  /// How many boxes are learned of a chunk with so many segments or triangles.
  static size_t learned_parts(size_t primitives);
  static constexpr size_t kPrimitivesPerPart = 1024, kMaxParts = 64;

  /// Of all but the tree, with all that may be learned.
  size_t bytes_bound() const { return bytes_bound_; }

 private:
  struct KnownBounds {
    FineBoxes fine;
    float margin = 0;
    bool learns = true;
    bool in_fur_tree = false;
  };

  std::vector<ChunkBounds> given_;  // until the tree is built
  std::vector<KnownBounds> known_;
  std::vector<std::atomic<const PartBoxes*>> learned_;
  std::vector<Box3f> whole_;
  std::vector<uint32_t> tree_parts_;
  std::unique_ptr<const ChunkTree> tree_;
  size_t bytes_bound_ = 0;
};

}  // namespace pelage
