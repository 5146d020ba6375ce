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

/// A fur tree that is stored in pages: data that all its treelets share.
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
  uint32_t page = 0;
  uint32_t tree = 0;
  uint32_t nodes = 0;   ///< offset in the page, a multiple of 64
  uint32_t leaves = 0;  ///< offset in the page, a multiple of 16: the end of the nodes
  uint32_t end = 0;     ///< end of the leaves
};

/// Data about all treelets that is available without their pages. Treelets are in the order of their pages.
struct FurPageTable {
  std::vector<FurPagedTree> trees;
  std::vector<FurTreelet> treelets;
  int box_keys = 1;
  /// By treelet and key, in scene units along the axes of its tree's frame: FurFrame applied to points of the
  /// scene. With two keys: at shutter open and close.
  std::vector<Box3f> boxes;
  std::vector<uint32_t> page_bytes;

  uint64_t total_page_bytes() const;
  uint32_t largest_page() const;
  /// Memory of this object.
  size_t bytes() const;
  /// Whether all numbers are consistent: pages, trees and offsets exist, boxes are finite, axes are
  /// orthonormal.
  bool is_possible() const;
};

/// Cuts fur trees into pages. A page contains consecutive treelets of a tree, which are therefore close
/// together in space; the levels above all treelets are replaced by a tree over their boxes.
///
/// A subtree that fits the remaining space of a page becomes a treelet. Otherwise, if the page is nearly
/// full, the page is closed; if not, the children of the subtree are tried. Pages are therefore filled to at
/// least kFull, except for the last.
class FurCutter {
 public:
  using Sink = std::function<void(std::span<const std::byte>)>;
  static constexpr size_t kPageBytes = size_t(128) << 10;

  /// `sink` receives page after page; it must copy what it needs.
  explicit FurCutter(Sink sink, size_t page_bytes = kPageBytes);
  ~FurCutter();

  /// Trees are numbered 0, 1, 2 ... An empty tree has no treelets.
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

/// The tree of one treelet in its page. The page must have been validated.
FurTreeView treelet_view(const FurPagedTree& tree, const FurTreelet& treelet, const std::byte* page);
/// Whether a treelet can be traced: every reference is valid, every node is the child of exactly one other,
/// and the depth is within the limit.
bool is_possible_treelet(const FurTreeView& view, const FurTreelet& treelet);

}  // namespace pelage
