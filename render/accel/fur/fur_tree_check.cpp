// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_tree_check.h"

#include <cmath>
#include <cstring>
#include <vector>

#include "render/accel/fur/fur_leaf.h"

namespace pelage {
namespace {

constexpr int kMaxLevels = 80;  // the kernels' stack holds the pending nodes of this many

size_t block_size(FurReference leaf, int motion_keys) {
  return (leaf.is_wide() ? kWideBlock : kNarrowBlock).block(motion_keys);
}

/// Whether no ray can hit a lane, because it is a single point without width at every key.
bool is_empty_lane(const std::byte* block, bool wide, size_t lane, int motion_keys) {
  for (int key = 0; key < motion_keys; ++key) {
    const SnappedSegment segment = read_block(block, wide, lane, key);
    for (const auto& point : segment) {
      for (size_t axis = 0; axis < 3; ++axis) {
        if (point[axis] != segment[0][axis]) return false;
      }
      if (point[3] != 0) return false;
    }
  }
  return true;
}

bool has_possible_numbers(const std::byte* block, bool wide, int motion_keys, size_t count) {
  FurBlockHeader header;
  std::memcpy(&header, block, sizeof(header));
  for (size_t lane = 0; lane < FurBlockHeader::kLanes; ++lane) {
    const uint32_t number = header.number[lane];
    const bool is_good =
        number == FurBlockHeader::kNone ? is_empty_lane(block, wide, lane, motion_keys) : number < count;
    if (!is_good) return false;
  }
  return true;
}

}  // namespace

bool has_possible_grid(const FurTreeView& tree) {
  const V3f& a = tree.anchor;
  int exponent = 0;
  return tree.motion_keys >= 1 && tree.motion_keys <= 64 && tree.step > 0 && std::isnormal(tree.step) &&
         std::frexp(tree.step, &exponent) == 0.5f && std::isfinite(a.x) && std::isfinite(a.y) &&
         std::isfinite(a.z) && tree.reach >= 0 && std::isfinite(tree.reach) && tree.frame.is_possible();
}

bool has_possible_nodes(const FurTreeView& tree, size_t node_bytes, size_t leaf_bytes) {
  const size_t size = FurQuantisedNode::size(tree.motion_keys);
  const size_t count = node_bytes / size;
  if (count == 0 || node_bytes % size != 0) return false;
  // Nodes are in depth-first order, so that one pass sees parents before their children.
  std::vector<uint8_t> level(count, 0);
  level[0] = 1;
  for (size_t n = 0; n < count; ++n) {
    if (level[n] == 0 || level[n] > kMaxLevels) return false;
    for (size_t i = 0; i < 4; ++i) {
      const FurReference r = child_reference(tree.nodes + n * size, i);
      if (r.is_none()) continue;
      if (r.is_leaf()) {
        if (r.leaf_offset() + r.blocks() * block_size(r, tree.motion_keys) > leaf_bytes) return false;
        continue;
      }
      const uint64_t child = r.node_offset() / size;
      if (r.node_offset() % size != 0 || child <= n || child >= count || level[child] != 0) return false;
      level[child] = static_cast<uint8_t>(level[n] + 1);
    }
  }
  return true;
}

bool has_possible_segments(const FurTreeView& tree, size_t node_bytes, size_t count) {
  for (size_t n = 0; n < node_bytes; n += FurQuantisedNode::size(tree.motion_keys)) {
    for (size_t i = 0; i < 4; ++i) {
      const FurReference r = child_reference(tree.nodes + n, i);
      if (!r.is_leaf()) continue;
      const std::byte* block = tree.leaves + r.leaf_offset();
      for (uint32_t b = 0; b < r.blocks(); ++b, block += block_size(r, tree.motion_keys)) {
        if (!has_possible_numbers(block, r.is_wide(), tree.motion_keys, count)) return false;
      }
    }
  }
  return true;
}

}  // namespace pelage
