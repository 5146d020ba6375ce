// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "procedurals/chunk_bounds.h"
#include "render/accel/accel.h"
#include "render/accel/ray_slabs.h"

namespace pelage {

class Workers;

/// Tells single rays which chunks they may meet, front to back: a tree, four boxes to a node, over the boxes
/// of all parts of all chunks. Where boxes are linear in time, a ray sees them as they are at its own time.
///
/// Thread safety: immutable.
class ChunkTree {
 public:
  /// The same tree for any number of workers. At most 2^31 - 1 chunks.
  ChunkTree(std::span<const ChunkBounds> chunks, const Workers& workers);

  /// Holds all boxes at all times; empty for none.
  const Box3f& bounds() const { return bounds_; }
  size_t bytes() const { return nodes_.capacity() * sizeof(Node) + motions_.capacity() * sizeof(FourBoxes); }

 private:
  friend class ChunkWalk;
  friend class ChunkTreeBuilder;

  static constexpr uint32_t kChunk = 1u << 31;  // a child that is a chunk, not a node

  struct Node {
    FourBoxes boxes;  // at shutter open; those of absent children are inside out
    std::array<uint32_t, 4> children;
  };

  std::vector<Node> nodes_;         // the root first
  std::vector<FourBoxes> motions_;  // how far the boxes of each node move until shutter close, or none
  Box3f bounds_;
  float reach_ = 0;  // largest coordinate
};

/// One ray on its way through a ChunkTree.
class ChunkWalk {
 public:
  enum class Order {
    kFrontToBack,   ///< for a ray that looks for the nearest
    kLongestFirst,  ///< by the ray's way through a box: for one that looks for anything in its way
  };
  ChunkWalk(const ChunkTree& tree, const Ray& ray, Order order);

  /// The next chunk that has a box which the ray meets between its near end and `far`, and where it enters
  /// that box at the earliest; in the order asked for, as far as the tree separates them. A chunk comes as
  /// often as it has such boxes. False when there is none. `far` may become smaller from call to call.
  bool next(float far, uint32_t& chunk, float& entry);

  const RaySlabs& slabs() const { return slabs_; }
  /// Boxes that were tested so far.
  int64_t box_tests() const { return 4 * nodes_tested_; }

 private:
  struct Entry {
    float distance;
    uint32_t child;
  };
  void open(uint32_t node, float far);

  const ChunkTree& tree_;
  const RaySlabs slabs_;
  const Order order_;
  int64_t nodes_tested_ = 0;
  size_t count_ = 0;
  std::array<Entry, 128> stack_;  // the next one last; see kMaxSahDepth of the builder
};

}  // namespace pelage
