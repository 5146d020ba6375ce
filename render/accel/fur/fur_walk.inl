// SPDX-License-Identifier: Apache-2.0
// Part of fur_kernels.cpp: traversal of a tree.

constexpr size_t kDeferred = 6;  // leaves that may be deferred: enough to hide the memory latency
// Nodes that may be deferred. A depth-first traversal keeps three per level, and trees have less than 70
// levels; beyond kMixed the traversal is depth-first.
constexpr size_t kStack = 512, kMixed = 256;

PELAGE_FUR_INLINE void fetch_lines(const std::byte* place, size_t bytes) {
  for (size_t i = 0; i < bytes; i += 64) hwy::Prefetch(place + i);
}

/// Appends the lanes `chosen` to a list in their order, without a branch; returns their number. The list must
/// have room for four.
PELAGE_FUR_INLINE size_t append(hn::Vec<Words> children, V enter, hn::Mask<Floats> chosen,
                                uint32_t* references, float* enters) {
  const auto packed = hn::BitCast(kWords, hn::Compress(hn::BitCast(kFloats, children), chosen));
  hn::StoreU(packed, kWords, references);
  hn::StoreU(hn::Compress(enter, chosen), kFloats, enters);
  return hn::CountTrue(kFloats, chosen);
}

/// Sorts two to four entries: the nearest comes last.
PELAGE_FUR_INLINE void order(size_t count, uint32_t* references, float* enters) {
  for (size_t i = 1; i < count; ++i) {
    const uint32_t reference = references[i];
    const float enter = enters[i];
    size_t place = i;
    for (; place > 0 && enters[place - 1] < enter; --place) {
      enters[place] = enters[place - 1];
      references[place] = references[place - 1];
    }
    enters[place] = enter;
    references[place] = reference;
  }
}

/// Traverses the tree, roughly front to back. Prefetches what will be visited later: leaves are deferred
/// until a few of them have accumulated, and where the order does not matter every node is deferred for one
/// visit.
template <Motion kMotion, class Query>
PELAGE_FUR_INLINE void walk(const FurTreeView& tree, const FurRay& ray, Query& query) {
  const QuantisedSlabs<kMotion == Motion::kKeys> slabs(ray);
  uint32_t nodes[kStack], leaves[kDeferred + 8];
  float node_enters[kStack], leaf_enters[kDeferred + 8];
  nodes[0] = 0;
  node_enters[0] = ray.near;
  size_t node_count = 1, leaf_count = 0;
  while (true) {
    while (node_count > 0 && leaf_count < kDeferred) {
      --node_count;
      uint32_t next = nodes[node_count];
      const float next_enter = node_enters[node_count];
      if (!Query::kOrdered && node_count > 0 && node_count < kMixed) std::swap(next, nodes[node_count - 1]);
      if (Query::kOrdered && next_enter > query.far()) continue;
      const std::byte* node = tree.nodes + FurReference::from_bits(next).node_offset();
      V enter = all(ray.near);
      const auto entered = slabs.intersect(node, enter, all(query.far()));
      const auto references = hn::LoadU(kWords, slabs.references(node));
      const auto is_leaf =
          hn::MaskFromVec(hn::BitCast(kFloats, hn::BroadcastSignBit(hn::BitCast(kInts, references))));
      const auto is_node = hn::RebindMask(kFloats, hn::Gt(hn::BitCast(kInts, references), hn::Zero(kInts)));
      const size_t more_nodes =
          append(references, enter, hn::And(entered, is_node), nodes + node_count, node_enters + node_count);
      const size_t more_leaves =
          append(references, enter, hn::And(entered, is_leaf), leaves + leaf_count, leaf_enters + leaf_count);
      if (Query::kOrdered && more_nodes > 1) order(more_nodes, nodes + node_count, node_enters + node_count);
      // Always all four: a loop with an early exit costs more than unnecessary prefetches.
      for (size_t i = 0; i < 4; ++i)
        fetch_lines(tree.nodes + FurReference::from_bits(nodes[node_count + i]).node_offset(), 64);
      for (size_t i = 0; i < 4; ++i)
        fetch_lines(tree.leaves + FurReference::from_bits(leaves[leaf_count + i]).leaf_offset(), 144);
      node_count += more_nodes;
      leaf_count += more_leaves;
    }
    if (leaf_count == 0) return;
    for (size_t i = 0; i < leaf_count; ++i) {
      if (leaf_enters[i] > query.far()) continue;
      if (test_leaf<kMotion>(tree, FurReference::from_bits(leaves[i]), ray, query)) return;
    }
    leaf_count = 0;
  }
}
