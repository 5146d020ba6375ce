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

/// One of the fur trees that lie in pages: what all its treelets have in common.
struct FurPagedTree {
  FurNodeLayout layout = FurNodeLayout::kQuantised;
  int32_t motion_keys = 1;
  float step = 1;
  V3f anchor{0};
  float reach = 0;
  FurFrame frame;
};

/// A part of a fur tree that is a fur tree by itself, and where it stands: nodes (the root first) and then
/// leaves, in one page. Its references count from the beginning of its own nodes and leaves.
struct FurTreelet {
  uint32_t page = 0;
  uint32_t tree = 0;
  uint32_t nodes = 0;   ///< offset in the page, a multiple of 64
  uint32_t leaves = 0;  ///< offset in the page, a multiple of 16: the end of the nodes
  uint32_t end = 0;     ///< of the leaves
};

/// What is known of all treelets without a page at hand. Treelets are in the order of their pages.
struct FurPageTable {
  std::vector<FurPagedTree> trees;
  std::vector<FurTreelet> treelets;
  int box_keys = 1;
  /// By treelet and key, in scene units along the axes of its tree's frame: FurFrame of points of the scene.
  /// Two keys stand at shutter open and close.
  std::vector<Box3f> boxes;
  std::vector<uint32_t> page_bytes;

  uint64_t total_page_bytes() const;
  uint32_t largest_page() const;
  /// What this object holds.
  size_t bytes() const;
  /// Whether all numbers fit together: pages, trees and offsets exist, boxes are finite, axes are axes.
  bool is_possible() const;
};

/// Cuts fur trees into pages. A page holds treelets that follow each other in the tree, and therefore lie
/// close together; what is above all treelets is left to a tree over their boxes.
///
/// A subtree that fits what is left of a page becomes a treelet. Of one that does not, the children are
/// tried, unless the page is nearly full: then it is closed. So pages are at least kFull full, up to the
/// last.
class FurCutter {
 public:
  using Sink = std::function<void(std::span<const std::byte>)>;
  static constexpr size_t kPageBytes = size_t(128) << 10;

  /// `sink` is given page after page; it copies what it needs.
  explicit FurCutter(Sink sink, size_t page_bytes = kPageBytes);
  ~FurCutter();

  /// Trees get the numbers 0, 1, 2 ... One that holds nothing has no treelets.
  void add(const FurTree& tree);
  /// Closes the last page. Nothing is added afterwards.
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

/// The tree of one treelet in its page. The page has been found possible.
FurTreeView treelet_view(const FurPagedTree& tree, const FurTreelet& treelet, const std::byte* page);
/// Whether rays can be traced through a treelet: every reference leads to where there is something, every
/// node is the child of one other, and the tree is not deeper than trees are.
bool is_possible_treelet(const FurTreeView& view, const FurTreelet& treelet);

}  // namespace pelage
