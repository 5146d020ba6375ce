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

/// Finds the chunks that single rays may hit, front to back: a 4-wide tree over the boxes of all parts of all
/// chunks. Boxes that are linear in time are evaluated at the time of the ray.
///
/// Thread safety: immutable.
class ChunkTree {
 public:
  /// The tree is the same for any number of workers. At most 2^31 - 1 chunks.
  ChunkTree(std::span<const ChunkBounds> chunks, const Workers& workers);

  /// Contains all boxes at all times; empty if there are no boxes.
  const Box3f& bounds() const { return bounds_; }
  size_t bytes() const { return nodes_.capacity() * sizeof(Node) + motions_.capacity() * sizeof(FourBoxes); }

 private:
  friend class ChunkWalk;
  friend class ChunkTreeBuilder;

  static constexpr uint32_t kChunk = 1u << 31;  // a child that is a chunk, not a node

  struct Node {
    FourBoxes boxes;  // at shutter open; boxes of missing children are inverted
    std::array<uint32_t, 4> children;
  };

  std::vector<Node> nodes_;         // the root first
  std::vector<FourBoxes> motions_;  // motion of each node's boxes until shutter close, or empty
  Box3f bounds_;
  float reach_ = 0;  // largest coordinate
};

/// Traversal of a ChunkTree by one ray.
class ChunkWalk {
 public:
  enum class Order {
    kFrontToBack,   ///< for rays that need the nearest hit
    kLongestFirst,  ///< by length of the ray inside a box: for rays that need any hit
  };
  ChunkWalk(const ChunkTree& tree, const Ray& ray, Order order);

  /// Finds the next chunk with a box that the ray intersects between its near end and `far`, and a lower
  /// bound of the distance at which the ray enters that box. The requested order holds among the children of
  /// each node, not across the whole tree. A chunk is returned once per intersected box. False when no chunk
  /// is left. `far` may decrease between calls.
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
  std::array<Entry, 128> stack_;  // the next one last; see kMaxSahDepth of the builder
};

}  // namespace pelage
