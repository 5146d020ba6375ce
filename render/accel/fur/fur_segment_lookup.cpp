// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_segment_lookup.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <vector>

#include "render/accel/fur/fur_leaf.h"
#include "render/accel/fur/fur_node.h"
#include "render/accel/fur/fur_reference.h"

namespace pelage {
namespace {

constexpr uint32_t kLanes = FurBlockHeader::kLanes;
constexpr uint32_t kWide = 1u << 31, kNowhere = ~0u;
constexpr uint16_t kShortNowhere = 0xffff;

/// Calls use(offset, wide) for every block of the leaves of a tree.
template <class Use>
void for_each_block(const FurTreeView& tree, const Use& use) {
  if (!tree.nodes) return;
  std::vector<uint64_t> waiting{0};
  while (!waiting.empty()) {
    const std::byte* node = tree.nodes + waiting.back();
    waiting.pop_back();
    for (size_t i = 0; i < 4; ++i) {
      const FurReference child = child_reference(node, i);
      if (child.is_none()) continue;
      if (!child.is_leaf()) {
        waiting.push_back(child.node_offset());
        continue;
      }
      const size_t size = (child.is_wide() ? kWideBlock : kNarrowBlock).block(tree.motion_keys);
      for (uint32_t b = 0; b < child.blocks(); ++b) use(child.leaf_offset() + b * size, child.is_wide());
    }
  }
}

}  // namespace

FurSegmentLookup::FurSegmentLookup(const FurTreeView& tree, uint32_t segment_count) {
  const size_t narrow = kNarrowBlock.block(tree.motion_keys);
  uint64_t blocks = 0;
  bool any_wide = false;
  for_each_block(tree, [&](uint64_t, bool wide) {
    ++blocks;
    any_wide |= wide;
  });
  short_ = !any_wide && blocks * kLanes <= kShortNowhere;
  block_ = PageBlock(segment_count * (short_ ? sizeof(uint16_t) : sizeof(uint32_t)));
  auto* short_places = reinterpret_cast<uint16_t*>(block_.data());
  auto* places = reinterpret_cast<uint32_t*>(block_.data());
  if (short_) {
    std::fill_n(short_places, segment_count, kShortNowhere);
  } else {
    std::fill_n(places, segment_count, kNowhere);
  }
  for_each_block(tree, [&](uint64_t offset, bool wide) {
    FurBlockHeader header;
    std::memcpy(&header, tree.leaves + offset, sizeof(header));
    for (uint32_t lane = 0; lane < kLanes; ++lane) {
      const uint32_t number = header.number[lane];
      if (number == FurBlockHeader::kNone) continue;
      if (short_) {
        short_places[number] = static_cast<uint16_t>(offset / narrow * kLanes + lane);
      } else {
        places[number] =
            static_cast<uint32_t>(offset / FurReference::kUnit * kLanes + lane) | (wide ? kWide : 0u);
      }
    }
  });
}

FurSegmentLookup::Place FurSegmentLookup::find(const FurTreeView& tree, uint32_t number) const {
  if (short_) {
    const uint32_t place = reinterpret_cast<const uint16_t*>(block_.data())[number];
    if (place == kShortNowhere) return {};
    return {tree.leaves + place / kLanes * kNarrowBlock.block(tree.motion_keys), place % kLanes, false};
  }
  const uint32_t place = reinterpret_cast<const uint32_t*>(block_.data())[number];
  if (place == kNowhere) return {};
  const uint32_t at = place & ~kWide;
  return {tree.leaves + uint64_t(at / kLanes) * FurReference::kUnit, at % kLanes, (place & kWide) != 0};
}

}  // namespace pelage
