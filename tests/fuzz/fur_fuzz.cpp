// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>

#include "base/page_block.h"
#include "render/accel/flush_denormals.h"
#include "render/accel/fur/fur_tree_check.h"
#include "tests/fuzz/fuzz_targets.h"

namespace pelage {
namespace {

Ray ray_of(int i) {
  Ray ray;
  ray.origin = V3f(0.1f * static_cast<float>(i) - 0.4f, 0.2f, 3);
  ray.direction = V3f(0.03f * static_cast<float>(i % 3), -0.02f, -1).normalized();
  ray.time = 0.1f * static_cast<float>(i);
  return ray;
}

}  // namespace

void fuzz_fur(std::span<const uint8_t> bytes) {
  if (bytes.size() < 64) return;
  // What the metadata of a chunk would say of the bytes that follow.
  FurTreeView tree;
  tree.motion_keys = 1 + bytes[1] % 3;
  tree.step = std::ldexp(1.0f, -8 + bytes[2] % 16);
  tree.reach = 1e4f;
  if (bytes[4] % 2 == 1) tree.frame = {{V3f(0.6f, 0.8f, 0), V3f(0, 0, 1), V3f(0.8f, -0.6f, 0)}, true};
  const std::span<const uint8_t> content = bytes.subspan(16);
  const size_t node_bytes = (size_t{1} + bytes[3]) * FurQuantisedNode::size(tree.motion_keys);
  if (node_bytes > content.size()) return;
  const size_t leaf_bytes = content.size() - node_bytes, leaves = FurTree::leaves_offset(node_bytes);
  PageBlock block(leaves + leaf_bytes);
  std::memcpy(block.data(), content.data(), node_bytes);
  std::memcpy(block.data() + leaves, content.data() + node_bytes, leaf_bytes);
  tree.nodes = block.data();
  tree.leaves = block.data() + leaves;
  if (!has_possible_grid(tree) || !has_possible_nodes(tree, node_bytes, leaf_bytes)) return;
  has_possible_segments(tree, node_bytes, 100);
  const FlushDenormals flush;
  for (int i = 0; i < 8; ++i) {
    closest_fur(tree, ray_of(i), {}, nullptr);
    fur_occludes(tree, ray_of(i), {}, nullptr);
  }
}

}  // namespace pelage
