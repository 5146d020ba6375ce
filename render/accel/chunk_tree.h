// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "procedurals/bounds/chunk_bounds.h"
#include "render/accel/accel.h"
#include "render/accel/ray_slabs.h"

namespace pelage {

class Workers;

/// A 4-wide tree over the boxes of the parts of all chunks (see ChunkBounds). ChunkWalk traverses the tree to
/// find the chunks that a ray may hit. Boxes that move are interpolated linearly to the time of the ray.
///
/// Thread safety: immutable.
class ChunkTree {
 public:
  /// Builds the same tree for any number of workers. There may be at most 2^31 - 1 chunks.
  ChunkTree(std::span<const ChunkBounds> chunks, const Workers& workers);

  /// Box that contains all boxes at all times of the shutter; empty if there are no boxes.
  const Box3f& bounds() const { return bounds_; }
  size_t bytes() const { return nodes_.capacity() * sizeof(Node) + motions_.capacity() * sizeof(FourBoxes); }

 private:
  friend class ChunkWalk;
  friend class ChunkTreeBuilder;

  static constexpr uint32_t kChunk = 1u << 31;  // set in a child that is a chunk rather than a node

  struct Node {
    FourBoxes boxes;  // at shutter open; boxes of missing children are inverted
    std::array<uint32_t, 4> children;
  };

  std::vector<Node> nodes_;         // the root first
  std::vector<FourBoxes> motions_;  // by node: displacement until shutter close; empty without motion
  Box3f bounds_;
  float reach_ = 0;  // largest absolute coordinate of a box
};

/// Traversal of a ChunkTree by one ray.
class ChunkWalk {
 public:
  enum class Order {
    kFrontToBack,   ///< for rays that need the nearest hit
    kLongestFirst,  ///< longest path inside the box first: for rays that need any hit
  };
  ChunkWalk(const ChunkTree& tree, const Ray& ray, Order order);

  /// Finds the next box that the ray intersects between its near end and `far`. Stores the number of the
  /// box's chunk in `chunk`, and a lower bound of the distance at which the ray enters the box in `entry`.
  /// Returns false when no box is left. A chunk with several intersected boxes is found once per box. The
  /// requested order holds among the children of each node, not across the whole tree. The caller may
  /// decrease `far` from call to call, but must not increase it.
  bool next(float far, uint32_t& chunk, float& entry);

  const RaySlabs& slabs() const { return slabs_; }
  /// Number of boxes tested so far.
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
  std::array<Entry, 128> stack_;  // the next entry is the last; size: see chunk_tree_builder.cpp
};

}  // namespace pelage
