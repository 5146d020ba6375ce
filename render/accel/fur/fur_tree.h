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
  FurBuildOptions build;
  PagePool* pool = nullptr;  ///< provides the tree's memory; null: the system provides it
};

/// The data needed to trace a tree. The nodes and leaves may be stored anywhere. Each FurReference is an
/// offset from `nodes` or from `leaves`. `nodes` is aligned to 64 bytes, `leaves` to 16 bytes.
struct FurTreeView {
  const std::byte* nodes = nullptr;  ///< the root first; null: the tree is empty
  const std::byte* leaves = nullptr;
  int motion_keys = 1;
  float step = 1;   ///< of the grid
  V3f anchor{0};    ///< of the grid
  float reach = 0;  ///< largest absolute coordinate of the boxes, in grid units
  FurFrame frame;   ///< axes of the nodes' boxes
};

/// Intersects rays with the strands of one groom. The tree is a 4-wide BVH [Neulander13]; its leaves store
/// cubic segments in blocks of four. A segment is a ribbon that faces the ray. A ray hits a segment at
/// parameter u if the distance between the ray and the segment's axis has a local minimum at u that is less
/// than the radius at u. Whether and where a ray hits a segment is a function of the ray and the segment
/// only. It depends neither on the tree's structure, nor on the instruction set or the ray's far
/// end.
///
/// All nodes and leaves are in one block of memory without pointers. Points are snapped (see FurGrid). The
/// tree has the only copy of the points. Strands without length or width are never hit. Thread safety:
/// immutable. Each query must be inside a FlushDenormals scope.
class FurTree {
 public:
  /// Builds the tree on the calling thread. `strands` need not outlive the constructor.
  FurTree(const SnappedStrands& strands, const FurTreeOptions& options);

  /// Makes a tree from a block that was read from a file: nodes at the beginning of the block, leaves from
  /// leaves_offset() on. The other members of the tree's view are copied from `like`. The caller must have
  /// validated the contents.
  FurTree(const FurTreeView& like, const FurBox& box, PageBlock block, size_t node_bytes, size_t leaf_bytes);
  static size_t leaves_offset(size_t node_bytes);
  /// Allocates memory for a tree; `pool` as in FurTreeOptions.
  static PageBlock make_block(PagePool* pool, size_t bytes);

  /// Returns the nearest hit in (near, far) that `filter` accepts, or the one with the smallest segment
  /// number of several equally near ones; an empty hit if there is none. A null `filter` accepts all hits.
  FurHit closest(const Ray& ray, const FurStart& start, FurFilter* filter = nullptr) const;
  /// Whether there is any hit in (near, far) that `filter` accepts. A null `filter` accepts all hits.
  bool occluded(const Ray& ray, const FurStart& start, FurFilter* filter = nullptr) const;

  const FurTreeView& view() const { return view_; }
  /// Box that contains all segments at all motion keys, in grid units, along the axes of the grid.
  const FurBox& box() const { return box_; }
  size_t bytes() const { return block_.bytes(); }
  /// Max bytes of memory in use while this tree was built, including the tree itself.
  size_t build_bytes() const { return build_bytes_; }
  /// Upper bound of build_bytes() for any tree over `segments` segments.
  static size_t build_bytes_bound(size_t segments, int motion_keys);
  size_t node_bytes() const { return node_bytes_; }
  size_t leaf_bytes() const { return leaf_bytes_; }

 private:
  class Writer;

  PageBlock block_;
  size_t node_bytes_ = 0, leaf_bytes_ = 0, build_bytes_ = 0;
  FurTreeView view_;
  FurBox box_;
};

/// Like FurTree::closest() and FurTree::occluded(), for any view.
FurHit closest_fur(const FurTreeView& tree, const Ray& ray, const FurStart& start, FurFilter* filter);
bool fur_occludes(const FurTreeView& tree, const Ray& ray, const FurStart& start, FurFilter* filter);

}  // namespace pelage
