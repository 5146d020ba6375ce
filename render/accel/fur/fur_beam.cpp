// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_beam.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "geom/four_lanes.h"
#include "render/accel/fur/fur_leaf.h"
#include "render/accel/fur/fur_node.h"

namespace pelage {
namespace {

constexpr float kRounding = 0x1p-19f;  // of a plane in the tree's frame, relative to the largest term
constexpr size_t kStack = 512;         // as in fur_walk.inl: more than three entries per level
/// Boxes are enlarged by this many steps of the grid before a sink tests whether they are hidden, because a
/// sink may draw strands wider by this length.
constexpr float kWider = 8;

template <class T>
T get(const std::byte* place) {
  T value;
  std::memcpy(&value, place, sizeof(value));
  return value;
}

Four bytes_at(const std::byte* place) {
  const auto b = get<std::array<uint8_t, 4>>(place);
  return Four{static_cast<float>(b[0]), static_cast<float>(b[1]), static_cast<float>(b[2]),
              static_cast<float>(b[3])};
}

/// Low and high sides of a node's children along an axis, at one key.
struct Sides {
  Four low, high;
};
Sides sides_of(const std::byte* node, size_t axis, size_t key) {
  const Four origin = four(get<float>(node + FurQuantisedNode::kOrigin + axis * sizeof(float)));
  const Four scale = four(get<float>(node + FurQuantisedNode::kScale + axis * sizeof(float)));
  const std::byte* at =
      node + FurQuantisedNode::kPlanes + key * FurQuantisedNode::kKey + axis * FurQuantisedNode::kAxis;
  return {origin + scale * bytes_at(at), origin + scale * bytes_at(at + FurQuantisedNode::kSide)};
}

/// A plane in the frame of a tree's boxes.
struct FramePlane {
  float normal[3];
  float offset = 0;
};

/// `outward`: moved outward by this many times the rounding of the plane and of boxes.
FramePlane in_frame(const FurTreeView& tree, const BeamPlane& plane, float outward) {
  double at_anchor = plane.offset;
  for (int axis = 0; axis < 3; ++axis)
    at_anchor += static_cast<double>(plane.normal[axis]) * tree.anchor[axis];
  const V3f normal = tree.step * (tree.frame.turned ? tree.frame(plane.normal) : plane.normal);
  const float largest =
      std::abs(plane.offset) + plane.normal.length() * (tree.anchor.length() + 2 * tree.step * tree.reach);
  return {{normal.x, normal.y, normal.z}, static_cast<float>(at_anchor) + outward * kRounding * largest};
}

/// Narrow and wide blocks of leaves.
Four coordinates(const std::byte* axis_values, bool wide, size_t point, int32_t origin) {
  if (wide) return get<Four>(axis_values + point * sizeof(Four));
  const auto w = get<std::array<uint16_t, 4>>(axis_values + point * 4 * sizeof(uint16_t));
  return four(static_cast<float>(origin)) + Four{static_cast<float>(w[0]), static_cast<float>(w[1]),
                                                 static_cast<float>(w[2]), static_cast<float>(w[3])};
}

FourSegments read_lanes(const std::byte* block, const FurBlockHeader& header, bool wide, size_t key) {
  const FurBlockSizes& sizes = wide ? kWideBlock : kNarrowBlock;
  const std::byte* at = block + sizeof(FurBlockHeader) + key * sizes.key();
  FourSegments result;
  for (size_t i = 0; i < 4; ++i) {
    result.p[i] = {coordinates(at, wide, i, header.origin[0]),
                   coordinates(at + sizes.axis, wide, i, header.origin[1]),
                   coordinates(at + 2 * sizes.axis, wide, i, header.origin[2])};
    const std::byte* radii = at + 3 * sizes.axis + i * (sizes.radii / 4);
    const Four root = wide ? Four{} : bytes_at(radii);
    result.r[i] = wide ? get<Four>(radii) : root * root * four(1.0f / 256);
  }
  return result;
}

class Visit {
 public:
  Visit(const FurTreeView& tree, const Beam& beam, PrimitiveSink& sink)
      : tree_(tree),
        view_{in_frame(tree, beam.across[0], 0), in_frame(tree, beam.across[1], 0),
              in_frame(tree, beam.depth, 0)},
        depth_(in_frame(tree, beam.depth, -1)),
        near_(beam.near - 2 * (in_frame(tree, beam.depth, 0).offset - depth_.offset)),
        sink_(sink),
        keys_(static_cast<size_t>(tree.motion_keys)) {
    for (size_t i = 0; i < sides_.size(); ++i) sides_[i] = in_frame(tree, beam.sides[i], 1);
    const BeamPlane* axes[3] = {&beam.across[0], &beam.across[1], &beam.depth};
    for (size_t i = 0; i < 3; ++i)
      outward_[i] = in_frame(tree, *axes[i], 1).offset - view_[i].offset + kWider * tree.step;
  }

  void run() {
    Entry stack[kStack];
    size_t count = open(tree_.nodes, stack);
    while (count > 0) {
      const Entry next = stack[--count];
      if (sink_.hides(next.footprint)) continue;
      if (next.child.is_leaf()) {
        visit_leaf(next.child);
      } else {
        count += open(tree_.nodes + next.child.node_offset(), stack + count);
      }
    }
  }

 private:
  struct Entry {
    ViewFootprint footprint;
    FurReference child;
  };

  /// Writes the children that meet the beam to `out`, the nearest last; returns their number.
  size_t open(const std::byte* node, Entry* out) const {
    Sides box[3];
    for (size_t axis = 0; axis < 3; ++axis) {
      box[axis] = sides_of(node, axis, 0);
      for (size_t key = 1; key < keys_.size(); ++key) {
        const Sides other = sides_of(node, axis, key);
        box[axis] = {smaller(box[axis].low, other.low), larger(box[axis].high, other.high)};
      }
    }
    // The largest or smallest value of a plane in each box.
    const auto extreme = [&](const FramePlane& plane, bool largest) {
      Four sum = four(plane.offset);
      for (size_t axis = 0; axis < 3; ++axis)
        sum +=
            four(plane.normal[axis]) * ((plane.normal[axis] > 0) == largest ? box[axis].high : box[axis].low);
      return sum;
    };
    Four inside = extreme(sides_[0], true);
    for (size_t i = 1; i < sides_.size(); ++i) inside = smaller(inside, extreme(sides_[i], true));
    inside = smaller(inside, extreme(depth_, true) - four(near_));
    const auto low = [&](size_t i) { return extreme(view_[i], false) - four(outward_[i]); };
    const auto high = [&](size_t i) { return extreme(view_[i], true) + four(outward_[i]); };
    ViewFootprint footprints[4];
    sink_.find_footprints({{low(0), low(1), low(2)}, {high(0), high(1), high(2)}}, footprints);
    size_t count = 0;
    for (size_t i = 0; i < 4; ++i) {
      if (!(inside[i] >= 0) || footprints[i].is_empty()) continue;
      const FurReference child = child_reference(node, i);
      if (child.is_none()) continue;
      const float depth = footprints[i].depth;
      size_t at = count++;
      for (; at > 0 && out[at - 1].footprint.depth < depth; --at) out[at] = out[at - 1];
      out[at] = {footprints[i], child};
    }
    return count;
  }

  void visit_leaf(FurReference leaf) {
    const std::byte* block = tree_.leaves + leaf.leaf_offset();
    const size_t size = (leaf.is_wide() ? kWideBlock : kNarrowBlock).block(tree_.motion_keys);
    for (uint32_t b = 0; b < leaf.blocks(); ++b, block += size) {
      const auto header = get<FurBlockHeader>(block);
      for (size_t key = 0; key < keys_.size(); ++key)
        keys_[key] = read_lanes(block, header, leaf.is_wide(), key);
      sink_.segments(header.number, keys_);
    }
  }

  const FurTreeView& tree_;
  std::array<FramePlane, 4> sides_;
  const FramePlane view_[3];  // the axes of the view
  float outward_[3] = {0, 0, 0};
  const FramePlane depth_;  // rounded down
  const float near_;
  PrimitiveSink& sink_;
  std::vector<FourSegments> keys_;
};

}  // namespace

void visit_segments(const FurTreeView& tree, const Beam& beam, PrimitiveSink& sink) {
  static_assert(PrimitiveSink::kNone == FurBlockHeader::kNone);
  if (!tree.nodes) return;
  sink.begin_segments({tree.anchor, tree.step, tree.motion_keys});
  Visit(tree, beam, sink).run();
}

}  // namespace pelage
