// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/vector.h"
#include "render/accel/fur/fur_tree.h"

namespace pelage {

/// The data that all treelets of one fur tree share. For the members, see FurTreeView.
struct FurPagedTree {
  FurNodeLayout layout = FurNodeLayout::kQuantised;
  int32_t motion_keys = 1;
  float step = 1;
  V3f anchor{0};
  float reach = 0;
  FurFrame frame;
};

/// A part of a fur tree that can be traced as a separate tree. It is stored in one page: nodes (the root
/// first) followed by leaves. References are relative to the nodes and leaves of the treelet.
struct FurTreelet {
  uint32_t page = 0;    ///< index of the page
  uint32_t tree = 0;    ///< index in FurPageTable::trees
  uint32_t nodes = 0;   ///< start of the nodes: byte offset in the page, a multiple of 64
  uint32_t leaves = 0;  ///< end of the nodes and start of the leaves: a multiple of 16
  uint32_t end = 0;     ///< end of the leaves
};

/// Data about all treelets that is available without their pages. Treelets are in the order of their pages.
struct FurPageTable {
  std::vector<FurPagedTree> trees;
  std::vector<FurTreelet> treelets;
  int box_keys = 1;  ///< number of boxes per treelet: 1, or 2 if any tree moves
  /// Boxes of the treelets, by treelet and key, in scene units and in the axes of the frame of the treelet's
  /// tree. To compare a point of the scene with a box, first apply the frame's operator() to the point. With
  /// one key, a box holds for the whole shutter. With two keys, the boxes are at shutter open and close.
  std::vector<Box3f> boxes;
  std::vector<uint32_t> page_bytes;

  uint64_t total_page_bytes() const;
  uint32_t largest_page() const;
  /// Bytes of memory that this object holds.
  size_t bytes() const;
  /// Whether the table is consistent: all pages, trees and offsets that it refers to exist, boxes are finite,
  /// and axes are orthonormal.
  bool is_possible() const;
};

/// Cuts fur trees into pages. A page contains treelets that are consecutive in depth-first order, and
/// therefore close together in space. The nodes above the treelets are not stored: PagedFur replaces them by
/// a tree over the treelets' boxes.
///
/// A subtree that fits into the remaining space of the page becomes a treelet. A subtree that does not fit,
/// but fits into an empty page, begins a new page if the current page is more than 7/8 full. Otherwise, the
/// children of the subtree are tried one by one. Therefore all pages except the last are usually more than
/// 7/8 full.
class FurCutter {
 public:
  using Sink = std::function<void(std::span<const std::byte>)>;
  static constexpr size_t kPageBytes = size_t(128) << 10;

  /// Calls `sink` with the bytes of each page in turn. `sink` must copy what it needs, because the memory is
  /// reused. `page_bytes`: max size of a page; less than 4 KiB counts as 4 KiB. Only a treelet that is larger
  /// by itself makes a larger page.
  explicit FurCutter(Sink sink, size_t page_bytes = kPageBytes);
  ~FurCutter();

  /// Adds a tree. The trees are numbered 0, 1, 2 ... in the order of calls. An empty tree has a number but no
  /// treelets.
  void add(const FurTree& tree);
  /// Closes the last page. Nothing may be added afterwards.
  FurPageTable finish();

 private:
  class Subtrees;

  void place(const Subtrees& tree, uint32_t node, std::span<const FurBox> boxes);
  void open(const Subtrees& tree, uint32_t node);
  std::byte* begin_treelet(size_t node_bytes, size_t leaf_bytes, std::span<const FurBox> boxes);
  void close_page();

  const Sink sink_;
  const size_t capacity_;
  std::unique_ptr<PageBlock> page_;
  size_t used_ = 0;
  bool moves_ = false;
  FurPageTable table_;
};

/// Returns the view of one treelet. `page`: the bytes of the treelet's page, which must be validated before
/// the view is traced.
FurTreeView treelet_view(const FurPagedTree& tree, const FurTreelet& treelet, const std::byte* page);
/// Whether a treelet can be traced: every reference is valid, every node except the root is the child of
/// exactly one node, and the depth is within the limit of the kernels.
bool is_possible_treelet(const FurTreeView& view, const FurTreelet& treelet);

}  // namespace pelage
