// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_pages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/check.h"
#include "render/accel/fur/fur_leaf.h"

namespace pelage {
namespace {

constexpr size_t kTreeletAlignment = 64, kLeafAlignment = 16;
constexpr size_t kSmallestPage = size_t(4) << 10;
constexpr int kDeepest = 80;  // max levels of a tree: the kernels' stack holds the pending nodes of this many
constexpr float kInfinity = std::numeric_limits<float>::infinity();

size_t aligned(size_t bytes) {
  return (bytes + kTreeletAlignment - 1) / kTreeletAlignment * kTreeletAlignment;
}

size_t leaf_size(FurReference leaf, int motion_keys) {
  return leaf.blocks() * (leaf.is_wide() ? kWideBlock : kNarrowBlock).block(motion_keys);
}

/// Converts grid units to scene units, rounding outward. For rotated boxes, rounding may have moved points by
/// up to 6 units in the last place of the largest coordinate.
Box3f scene_box(const FurPagedTree& tree, const FurBox& box) {
  Box3f result;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<size_t>(axis);
    const double anchor =
        tree.frame.turned ? V3d(tree.frame.axes[a]).dot(V3d(tree.anchor)) : double(tree.anchor[axis]);
    const double margin = tree.frame.turned ? 0x1p-21 * tree.reach * tree.step : 0;
    const auto place = [&](float grid) { return double(grid) * tree.step + anchor; };
    result.min[axis] = std::nextafter(static_cast<float>(place(box.low[a]) - margin), -kInfinity);
    result.max[axis] = std::nextafter(static_cast<float>(place(box.high[a]) + margin), kInfinity);
  }
  return result;
}

bool is_finite(const V3f& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool is_possible(const FurPagedTree& tree) {
  const bool layout = tree.layout == FurNodeLayout::kFloat || tree.layout == FurNodeLayout::kQuantised;
  int exponent = 0;
  return layout && tree.motion_keys >= 1 && tree.motion_keys <= 64 && tree.step > 0 &&
         std::isnormal(tree.step) && std::frexp(tree.step, &exponent) == 0.5f && is_finite(tree.anchor) &&
         tree.reach >= 0 && std::isfinite(tree.reach) && tree.frame.is_possible();
}

}  // namespace

uint64_t FurPageTable::total_page_bytes() const {
  uint64_t total = 0;
  for (const uint32_t bytes : page_bytes) total += bytes;
  return total;
}

uint32_t FurPageTable::largest_page() const {
  return page_bytes.empty() ? 0 : *std::max_element(page_bytes.begin(), page_bytes.end());
}

size_t FurPageTable::bytes() const {
  return trees.capacity() * sizeof(trees[0]) + treelets.capacity() * sizeof(treelets[0]) +
         boxes.capacity() * sizeof(boxes[0]) + page_bytes.capacity() * sizeof(page_bytes[0]);
}

bool FurPageTable::is_possible() const {
  if (box_keys != 1 && box_keys != 2) return false;
  if (boxes.size() != treelets.size() * static_cast<size_t>(box_keys)) return false;
  for (const FurPagedTree& tree : trees) {
    if (!pelage::is_possible(tree)) return false;
  }
  for (const Box3f& box : boxes) {
    if (box.isEmpty() || !is_finite(box.min) || !is_finite(box.max)) return false;
  }
  uint32_t page = 0, end = 0;
  for (const FurTreelet& t : treelets) {
    if (t.page >= page_bytes.size() || t.page < page || t.tree >= trees.size()) return false;
    if (t.page > page) page = t.page, end = 0;
    if (t.nodes < end || t.nodes % kTreeletAlignment != 0 || t.leaves % kLeafAlignment != 0) return false;
    if (t.leaves < t.nodes || t.end < t.leaves || t.end > page_bytes[page]) return false;
    end = t.end;
  }
  return true;
}

/// A tree in memory order: nodes in depth-first order, leaves in the order of their nodes, so that every
/// subtree is a range of both.
class FurCutter::Subtrees {
 public:
  explicit Subtrees(const FurTree& tree)
      : view(tree.view()),
        node_bytes(node_size(view.layout, view.motion_keys)),
        keys(static_cast<size_t>(view.motion_keys)),
        ends_(tree.node_bytes() / node_bytes),
        first_leaf_(ends_.size() + 1) {
    first_leaf_.back() = static_cast<uint64_t>(tree.leaf_bytes());
    uint64_t leaf = first_leaf_.back();
    for (size_t n = ends_.size(); n-- > 0;) {
      uint32_t end = static_cast<uint32_t>(n) + 1;
      for (size_t i = 0; i < 4; ++i) {
        const FurReference r = child(static_cast<uint32_t>(n), i);
        if (r.is_none()) break;
        if (r.is_leaf()) {
          leaf -= leaf_size(r, view.motion_keys);
        } else {
          PELAGE_CHECK(index(r) == end);
          end = ends_[index(r)];
        }
      }
      ends_[n] = end;
      first_leaf_[n] = leaf;
    }
    PELAGE_CHECK(leaf == 0);
  }

  size_t size() const { return ends_.size(); }
  uint32_t end(uint32_t node) const { return ends_[node]; }
  uint64_t first_leaf(uint32_t node) const { return first_leaf_[node]; }
  size_t nodes_size(uint32_t node) const { return (ends_[node] - node) * node_bytes; }
  size_t leaves_size(uint32_t node) const { return first_leaf_[ends_[node]] - first_leaf_[node]; }
  size_t bytes(uint32_t node) const { return nodes_size(node) + leaves_size(node); }
  const std::byte* node(uint32_t n) const { return view.nodes + n * node_bytes; }
  FurReference child(uint32_t n, size_t i) const {
    return child_reference(view.layout, view.motion_keys, node(n), i);
  }
  uint32_t index(FurReference r) const { return static_cast<uint32_t>(r.node_offset() / node_bytes); }
  std::vector<FurBox> boxes(uint32_t n, size_t i) const {
    std::vector<FurBox> result(keys);
    for (size_t key = 0; key < keys; ++key) {
      result[key] = child_box(view.layout, node(n), i, static_cast<int>(key));
    }
    return result;
  }
  /// Boxes of all children.
  std::vector<FurBox> boxes(uint32_t n) const {
    std::vector<FurBox> result(keys);
    for (size_t i = 0; i < 4 && !child(n, i).is_none(); ++i) {
      const std::vector<FurBox> of_child = boxes(n, i);
      for (size_t key = 0; key < keys; ++key) result[key].extend(of_child[key]);
    }
    return result;
  }

  const FurTreeView& view;
  const size_t node_bytes, keys;

 private:
  std::vector<uint32_t> ends_;        // one past the last node of each subtree
  std::vector<uint64_t> first_leaf_;  // start of each subtree's leaves
};

FurCutter::FurCutter(Sink sink, size_t page_bytes)
    : sink_(std::move(sink)), capacity_(aligned(std::max(page_bytes, kSmallestPage))) {}
FurCutter::~FurCutter() = default;

void FurCutter::add(const FurTree& tree) {
  const FurTreeView& view = tree.view();
  table_.trees.push_back({view.layout, view.motion_keys, view.step, view.anchor, view.reach, view.frame});
  moves_ = moves_ || view.motion_keys > 1;
  if (!view.nodes) return;
  const Subtrees subtrees(tree);
  std::vector<FurBox> whole(subtrees.keys, tree.box());
  if (view.frame.turned) whole = subtrees.boxes(0);
  place(subtrees, 0, whole);
}

void FurCutter::place(const Subtrees& tree, uint32_t node, std::span<const FurBox> boxes) {
  const size_t bytes = tree.bytes(node);
  if (used_ + bytes > capacity_) {
    const bool nearly_full = used_ > capacity_ - capacity_ / 8;
    if (!nearly_full || bytes > capacity_) return open(tree, node);
  }
  const size_t leaves = tree.nodes_size(node);
  std::byte* out = begin_treelet(leaves, tree.leaves_size(node), boxes);
  std::memcpy(out, tree.node(node), leaves);
  std::memcpy(out + leaves, tree.view.leaves + tree.first_leaf(node), tree.leaves_size(node));
  for (uint32_t n = node; n < tree.end(node); ++n) {
    for (size_t i = 0; i < 4; ++i) {
      const FurReference r = tree.child(n, i);
      if (r.is_none()) break;
      const FurReference own = r.is_leaf() ? FurReference::to_leaf(r.leaf_offset() - tree.first_leaf(node),
                                                                   r.blocks(), r.is_wide())
                                           : FurReference::to_node(r.node_offset() - node * tree.node_bytes);
      set_child_reference(tree.view.layout, tree.view.motion_keys, out + (n - node) * tree.node_bytes, i,
                          own);
    }
  }
}

/// Adds the children of a node one by one; its leaves form their own treelet.
void FurCutter::open(const Subtrees& tree, uint32_t node) {
  std::array<std::vector<FurBox>, 4> boxes;
  std::array<FurChild, 4> leaves;
  std::array<uint64_t, 4> sources;
  std::vector<FurBox> whole(tree.keys);
  size_t count = 0;
  uint64_t bytes = 0;
  for (size_t i = 0; i < 4; ++i) {
    const FurReference r = tree.child(node, i);
    if (r.is_none()) break;
    boxes[i] = tree.boxes(node, i);
    if (!r.is_leaf()) continue;
    leaves[count] = {FurReference::to_leaf(bytes, r.blocks(), r.is_wide()), boxes[i]};
    sources[count++] = r.leaf_offset();
    bytes += leaf_size(r, tree.view.motion_keys);
    for (size_t key = 0; key < tree.keys; ++key) whole[key].extend(boxes[i][key]);
  }
  if (count > 0) {
    std::byte* out = begin_treelet(tree.node_bytes, bytes, whole);
    write_node(tree.view.layout, tree.view.motion_keys, std::span(leaves).first(count), out);
    out += tree.node_bytes;
    for (size_t i = 0; i < count; ++i) {
      const size_t size = leaf_size(leaves[i].reference, tree.view.motion_keys);
      std::memcpy(out + leaves[i].reference.leaf_offset(), tree.view.leaves + sources[i], size);
    }
  }
  for (size_t i = 0; i < 4; ++i) {
    const FurReference r = tree.child(node, i);
    if (r.is_none()) break;
    if (!r.is_leaf()) place(tree, tree.index(r), boxes[i]);
  }
}

/// Allocates space for a treelet, in this page or the next.
std::byte* FurCutter::begin_treelet(size_t node_bytes, size_t leaf_bytes, std::span<const FurBox> boxes) {
  const size_t bytes = node_bytes + leaf_bytes;
  if (used_ > 0 && used_ + bytes > capacity_) close_page();
  if (!page_ || page_->bytes() < bytes) page_ = std::make_unique<PageBlock>(std::max(capacity_, bytes));
  const auto nodes = static_cast<uint32_t>(used_);
  const auto leaves = static_cast<uint32_t>(used_ + node_bytes);
  const auto end = static_cast<uint32_t>(used_ + bytes);
  table_.treelets.push_back({static_cast<uint32_t>(table_.page_bytes.size()),
                             static_cast<uint32_t>(table_.trees.size() - 1), nodes, leaves, end});
  // Boxes are linear between two keys; with more keys, one box contains all of them.
  const FurPagedTree& tree = table_.trees.back();
  FurBox all;
  for (const FurBox& box : boxes) all.extend(box);
  table_.boxes.push_back(scene_box(tree, boxes.size() == 2 ? boxes[0] : all));
  table_.boxes.push_back(scene_box(tree, boxes.size() == 2 ? boxes[1] : all));
  std::byte* out = page_->data() + used_;
  const size_t padded = std::min(aligned(end), page_->bytes());
  std::memset(page_->data() + end, 0, padded - end);
  used_ = padded;
  return out;
}

void FurCutter::close_page() {
  if (used_ == 0) return;
  sink_({page_->data(), used_});
  table_.page_bytes.push_back(static_cast<uint32_t>(used_));
  used_ = 0;
}

FurPageTable FurCutter::finish() {
  close_page();
  table_.box_keys = 2;
  if (!moves_) {
    table_.box_keys = 1;
    for (size_t i = 0; i < table_.treelets.size(); ++i) table_.boxes[i] = table_.boxes[2 * i];
    table_.boxes.resize(table_.treelets.size());
  }
  table_.boxes.shrink_to_fit();
  table_.treelets.shrink_to_fit();
  return std::move(table_);
}

FurTreeView treelet_view(const FurPagedTree& tree, const FurTreelet& treelet, const std::byte* page) {
  return {page + treelet.nodes,
          page + treelet.leaves,
          tree.layout,
          tree.motion_keys,
          tree.step,
          tree.anchor,
          tree.reach,
          tree.frame};
}

bool is_possible_treelet(const FurTreeView& view, const FurTreelet& treelet) {
  const size_t size = node_size(view.layout, view.motion_keys);
  const size_t node_bytes = treelet.leaves - treelet.nodes, leaf_bytes = treelet.end - treelet.leaves;
  const size_t count = node_bytes / size;
  if (count == 0 || node_bytes % size != 0) return false;
  // Nodes are in depth-first order, so that one pass sees parents before their children.
  std::vector<uint8_t> depth(count, 0);
  depth[0] = 1;
  for (size_t n = 0; n < count; ++n) {
    if (depth[n] == 0 || depth[n] > kDeepest) return false;
    for (size_t i = 0; i < 4; ++i) {
      const FurReference r = child_reference(view.layout, view.motion_keys, view.nodes + n * size, i);
      if (r.is_none()) continue;
      if (r.is_leaf()) {
        if (r.leaf_offset() + leaf_size(r, view.motion_keys) > leaf_bytes) return false;
        continue;
      }
      const uint64_t child = r.node_offset() / size;
      if (r.node_offset() % size != 0 || child <= n || child >= count || depth[child] != 0) return false;
      depth[child] = static_cast<uint8_t>(depth[n] + 1);
    }
  }
  return true;
}

}  // namespace pelage
