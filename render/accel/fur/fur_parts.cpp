// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_parts.h"

#include <algorithm>
#include <vector>

#include "render/accel/part_bounds.h"

namespace pelage {
namespace {

struct Subtree {
  FurReference reference;
  std::vector<FurBox> boxes;  // by key
  double area = 0;            // over all keys
};

void add_children(const FurTreeView& tree, const std::byte* node, std::vector<Subtree>& out) {
  for (size_t i = 0; i < 4; ++i) {
    Subtree child{child_reference(node, i), {}, 0};
    if (child.reference.is_none()) continue;
    for (int key = 0; key < tree.motion_keys; ++key) {
      child.boxes.push_back(tree.frame.unrotated(child_box(node, i, key)));
      child.area += child.boxes.back().area();
    }
    out.push_back(std::move(child));
  }
}

Box3f to_scene(const FurTreeView& tree, const FurBox& box) {
  Box3f result;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<size_t>(axis);
    const auto scene = [&](float grid) {
      return static_cast<float>(tree.anchor[axis] + static_cast<double>(grid) * tree.step);
    };
    result.min[axis] = scene(box.low[a]);
    result.max[axis] = scene(box.high[a]);
  }
  return result;
}

}  // namespace

ChunkBounds subtree_bounds(const FurTreeView& tree, size_t parts) {
  ChunkBounds bounds;
  const int last = tree.motion_keys - 1;
  bounds.keys = last > 0 ? 2 : 1;
  if (!tree.nodes) return bounds;
  std::vector<Subtree> subtrees;
  add_children(tree, tree.nodes, subtrees);
  while (subtrees.size() < parts) {
    const auto openable = [](const Subtree& s) { return s.reference.is_leaf() ? -1.0 : s.area; };
    const auto largest =
        std::max_element(subtrees.begin(), subtrees.end(),
                         [&](const Subtree& a, const Subtree& b) { return openable(a) < openable(b); });
    if (largest->reference.is_leaf()) break;
    const std::byte* node = tree.nodes + largest->reference.node_offset();
    subtrees.erase(largest);
    add_children(tree, node, subtrees);
  }
  for (const Subtree& subtree : subtrees) {
    Box3f open = to_scene(tree, subtree.boxes.front());
    if (last == 0) {
      bounds.boxes.push_back(open);
      continue;
    }
    Box3f close = to_scene(tree, subtree.boxes.back());
    for (int key = 1; key < last; ++key) {
      hold_at(open, close, to_scene(tree, subtree.boxes[static_cast<size_t>(key)]),
              static_cast<float>(key) / static_cast<float>(last));
    }
    bounds.boxes.push_back(open);
    bounds.boxes.push_back(close);
  }
  return bounds;
}

}  // namespace pelage
