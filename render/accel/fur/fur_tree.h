// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/page_block.h"
#include "base/page_pool.h"
#include "render/accel/fur/fur_hit.h"
#include "render/accel/fur/fur_node.h"
#include "render/accel/fur/fur_topology.h"
#include "render/accel/fur/snapped_strands.h"

namespace pelage {

struct FurTreeOptions {
  FurNodeLayout layout = FurNodeLayout::kQuantised;
  FurBuildOptions build;
  PagePool* pool = nullptr;  ///< where the tree's memory comes from, if not from the system
};

/// What tracing needs of a tree: nodes and leaves wherever they stand. References are relative to the two
/// pointers, which are aligned to 64 and 16 bytes.
struct FurTreeView {
  const std::byte* nodes = nullptr;  ///< the root first; null: nothing to meet
  const std::byte* leaves = nullptr;
  FurNodeLayout layout = FurNodeLayout::kQuantised;
  int motion_keys = 1;
  float step = 1;   ///< of the grid
  V3f anchor{0};    ///< of the grid
  float reach = 0;  ///< largest coordinate of the boxes, in grid units
  FurFrame frame;   ///< in which the boxes of nodes stand
};

/// Rays against the strands of one groom: a 4-wide BVH [Neulander13] over cubic segments, four of them to a
/// block, which are ribbons that face every ray: the ray meets the segment at parameter u where its distance
/// to the axis has a local minimum that is less than the radius. Whether and where is a function of the ray
/// and the segment alone: neither the tree's shape and layout nor the instruction set nor the ray's far end
/// reaches it.
///
/// Everything is one block of memory that holds no pointer. Points are snapped (see FurGrid), and the tree
/// has the only copy of them. Strands of no length or no width are never met. Thread safety: immutable. Each
/// query inside a FlushDenormals scope.
class FurTree {
 public:
  /// Built by the calling thread alone. The strands are not needed afterwards.
  FurTree(const SnappedStrands& strands, const FurTreeOptions& options);

  /// The tree that was kept in a file: nodes at the beginning of the block, leaves from leaves_offset() on.
  /// `like` says the rest of its view. They have been found possible.
  FurTree(const FurTreeView& like, const FurBox& box, PageBlock block, size_t node_bytes, size_t leaf_bytes);
  static size_t leaves_offset(size_t node_bytes);
  /// The memory for a tree; `pool` as FurTreeOptions.
  static PageBlock make_block(PagePool* pool, size_t bytes);

  /// The hit in (near, far) that stands first; `filter` may be null.
  FurHit closest(const Ray& ray, const FurStart& start, FurFilter* filter = nullptr) const;
  /// Whether there is any hit in (near, far) that `filter`, if any, accepts.
  bool occluded(const Ray& ray, const FurStart& start, FurFilter* filter = nullptr) const;

  const FurTreeView& view() const { return view_; }
  /// Box of everything, in grid units and along the grid, over all motion keys.
  const FurBox& box() const { return box_; }
  size_t bytes() const { return block_.bytes(); }
  /// Most that was held while it was built, itself included.
  size_t build_bytes() const { return build_bytes_; }
  /// At least build_bytes() of every tree over so many segments.
  static size_t build_bytes_bound(size_t segments, int motion_keys, const FurTreeOptions& options);
  size_t node_bytes() const { return node_bytes_; }
  size_t leaf_bytes() const { return leaf_bytes_; }

 private:
  class Writer;

  PageBlock block_;
  size_t node_bytes_ = 0, leaf_bytes_ = 0, build_bytes_ = 0;
  FurTreeView view_;
  FurBox box_;
};

/// The queries of FurTree on any view. What they cost is added to `tests`, unless it is null.
FurHit closest_fur(const FurTreeView& tree, const Ray& ray, const FurStart& start, FurFilter* filter,
                   FurTests* tests = nullptr);
bool fur_occludes(const FurTreeView& tree, const Ray& ray, const FurStart& start, FurFilter* filter,
                  FurTests* tests = nullptr);

}  // namespace pelage
