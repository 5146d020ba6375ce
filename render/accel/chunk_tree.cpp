// SPDX-License-Identifier: Apache-2.0
#include "render/accel/chunk_tree.h"

namespace pelage {

ChunkWalk::ChunkWalk(const ChunkTree& tree, const Ray& ray) : tree_(tree), slabs_(ray, tree.reach_) {
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
  Four enter;
  const auto met =
      slabs_.meet(node.boxes, tree_.motions_.empty() ? nullptr : &tree_.motions_[index], far, enter);
  // Sorted into the stack, the nearest on top.
  const size_t base = count_;
  for (size_t lane = 0; lane < 4; ++lane) {
    if (!met[lane]) continue;
    const Entry entry{enter[lane], node.children[lane]};
    size_t at = count_++;
    for (; at > base && stack_[at - 1].distance < entry.distance; --at) stack_[at] = stack_[at - 1];
    stack_[at] = entry;
  }
}

}  // namespace pelage
