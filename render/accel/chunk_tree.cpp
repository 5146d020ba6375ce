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
  const auto met = slabs_.meet(node.boxes, motion, far, enter, leave);
  const Four rank = order_ == Order::kFrontToBack ? enter : enter - leave;
  std::array<size_t, 4> lanes;  // of the boxes met, those that come first at the end
  size_t count = 0;
  for (size_t lane = 0; lane < 4; ++lane) {
    if (!met[lane]) continue;
    size_t at = count++;
    for (; at > 0 && rank[lanes[at - 1]] < rank[lane]; --at) lanes[at] = lanes[at - 1];
    lanes[at] = lane;
  }
  for (size_t i = 0; i < count; ++i) stack_[count_++] = {enter[lanes[i]], node.children[lanes[i]]};
}

}  // namespace pelage
