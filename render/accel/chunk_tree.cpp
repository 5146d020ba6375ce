// SPDX-License-Identifier: Apache-2.0
#include "render/accel/chunk_tree.h"

namespace pelage {

ChunkWalk::ChunkWalk(const ChunkTree& tree, const Ray& ray, Order order)
    : tree_(tree), slabs_(ray, tree.reach_), order_(order) {
  if (!tree.nodes_.empty()) stack_[count_++] = {ray.near, 0};
}

bool ChunkWalk::next(float far, uint32_t& chunk, float& entry) {
  while (count_ > 0) {
    const Entry top = stack_[--count_];
    if (top.distance > far) continue;
    if (top.child & ChunkTree::kChunk) {
      chunk = top.child & ~ChunkTree::kChunk;
      entry = top.distance;
      return true;
    }
    open(top.child, far);
  }
  return false;
}

void ChunkWalk::open(uint32_t index, float far) {
  ++nodes_tested_;
  const ChunkTree::Node& node = tree_.nodes_[index];
  const FourBoxes* motion = tree_.motions_.empty() ? nullptr : &tree_.motions_[index];
  Four enter, leave;
  const auto entered = slabs_.intersect(node.boxes, motion, far, enter, leave);
  const Four rank = order_ == Order::kFrontToBack ? enter : enter - leave;
  // Writes all four and counts the intersected ones: avoids unpredictable branches.
  Entry* entries = &stack_[count_];
  std::array<float, 5> ranks;
  size_t count = 0;
  for (size_t lane = 0; lane < 4; ++lane) {
    entries[count] = {enter[lane], node.children[lane]};
    ranks[count] = rank[lane];
    count += entered[lane] & 1;
  }
  count_ += count;
  // The first ones go to the end.
  for (size_t i = 1; i < count; ++i) {
    const Entry entry = entries[i];
    const float of_entry = ranks[i];
    size_t at = i;
    for (; at > 0 && ranks[at - 1] < of_entry; --at) {
      entries[at] = entries[at - 1];
      ranks[at] = ranks[at - 1];
    }
    entries[at] = entry;
    ranks[at] = of_entry;
  }
}

}  // namespace pelage
