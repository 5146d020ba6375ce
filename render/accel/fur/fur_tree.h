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
  PagePool* pool = nullptr;  ///< provides the tree's memory; null: the system
};

/// The data needed to trace a tree: nodes and leaves, wherever they are stored. References are relative to
/// the two pointers, which are aligned to 64 and 16 bytes.
struct FurTreeView {
  const std::byte* nodes = nullptr;  ///< the root first; null: empty
  const std::byte* leaves = nullptr;
  FurNodeLayout layout = FurNodeLayout::kQuantised;
  int motion_keys = 1;
  float step = 1;   ///< of the grid
  V3f anchor{0};    ///< of the grid
  float reach = 0;  ///< max coordinate of the boxes, in grid units
  FurFrame frame;   ///< axes of the nodes' boxes
};

/// Intersection of rays with the strands of one groom: a 4-wide BVH [Neulander13] over cubic segments in
/// blocks of four, which are ribbons that face every ray. A ray hits a segment at parameter u where its
/// distance to the axis has a local minimum below the radius. The result is a function of the ray and the
/// segment only: it depends neither on the tree's structure and layout, nor on the instruction set or the
/// ray's far end.
///
/// Everything is in one block of memory without pointers. Points are snapped (see FurGrid), and the tree has
/// the only copy of them. Strands without length or width are never hit. Thread safety: immutable. Each query
/// must be inside a FlushDenormals scope.
class FurTree {
 public:
  /// Built by the calling thread only. The strands are not needed afterwards.
  FurTree(const SnappedStrands& strands, const FurTreeOptions& options);

  /// A tree read from a file: nodes at the beginning of the block, leaves from leaves_offset() on. `like`
  /// provides the rest of its view. The contents must have been validated.
  FurTree(const FurTreeView& like, const FurBox& box, PageBlock block, size_t node_bytes, size_t leaf_bytes);
  static size_t leaves_offset(size_t node_bytes);
  /// Allocates memory for a tree; `pool` as in FurTreeOptions.
  static PageBlock make_block(PagePool* pool, size_t bytes);

  /// The first hit in (near, far), in the order of FurHit::precedes(); `filter` may be null.
  FurHit closest(const Ray& ray, const FurStart& start, FurFilter* filter = nullptr) const;
  /// Whether there is any hit in (near, far) that `filter`, if any, accepts.
  bool occluded(const Ray& ray, const FurStart& start, FurFilter* filter = nullptr) const;

  const FurTreeView& view() const { return view_; }
  /// Box of everything, in grid units and along the grid, over all motion keys.
  const FurBox& box() const { return box_; }
  size_t bytes() const { return block_.bytes(); }
  /// Max memory in use while it was built, including itself.
  size_t build_bytes() const { return build_bytes_; }
  /// Upper bound of build_bytes() for any tree over this number of segments.
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

/// The queries of FurTree on any view. Adds their cost to `tests`, unless it is null.
FurHit closest_fur(const FurTreeView& tree, const Ray& ray, const FurStart& start, FurFilter* filter,
                   FurTests* tests = nullptr);
bool fur_occludes(const FurTreeView& tree, const Ray& ray, const FurStart& start, FurFilter* filter,
                  FurTests* tests = nullptr);

}  // namespace pelage
