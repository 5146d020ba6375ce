// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_tree.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/error.h"
#include "render/accel/fur/fur_leaf.h"

namespace pelage {
namespace {

constexpr size_t kNodeAlignment = 64;

FurBox hull(const SnappedSegment& segment) {
  FurBox box;
  for (const auto& p : segment) {
    for (size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], p[axis] - p[3]);
      box.high[axis] = std::max(box.high[axis], p[axis] + p[3]);
    }
  }
  return box;
}

}  // namespace

/// Writes a topology twice: once to count bytes, once in place. Nodes stand in the order of a walk down the
/// tree, and so do leaves, those of one node side by side.
class FurTree::Writer {
 public:
  Writer(const SnappedStrands& strands, const FurTopology& topology, FurNodeLayout layout)
      : strands_(strands),
        topology_(topology),
        layout_(layout),
        keys_(static_cast<size_t>(strands.motion_keys())),
        node_size_(node_size(layout, strands.motion_keys())) {}

  /// Counts bytes. Leaves are read here for the first time: which of them are wide is kept.
  void measure() {
    node_bytes_ = topology_.nodes.size() * node_size_;
    for (const FurTopology::Node& node : topology_.nodes) {
      for (const FurTopology::Child& child : std::span(node.children).first(node.child_count)) {
        if (child.count == 0) continue;
        const bool wide = is_wide(child);
        wide_.push_back(wide);
        leaf_bytes_ += block_count(child) * block_size(wide);
      }
    }
    const auto too_large = node_bytes_ > FurReference::kNodeReach || leaf_bytes_ > FurReference::kLeafReach;
    if (too_large)
      throw Error(ErrorKind::kMemory,
                  "one fur tree would need more than 4 GiB: make chunks of fewer strands");
  }
  size_t node_bytes() const { return node_bytes_; }
  size_t leaf_bytes() const { return leaf_bytes_; }
  /// What is held while it writes, for so many nodes.
  static size_t scratch_bytes(size_t nodes, size_t keys) {
    return nodes * (4 * keys * sizeof(FurBox) + keys * sizeof(FurBox) + 4 * sizeof(FurReference) + 1) +
           FurBlockHeader::kLanes * keys * sizeof(SnappedSegment);
  }

  /// Fills both parts; returns the boxes of everything, one per key.
  std::vector<FurBox> write(std::byte* nodes, std::byte* leaves) {
    nodes_ = nodes, leaves_ = leaves;
    boxes_.resize(topology_.nodes.size() * 4 * keys_);
    node_boxes_.resize(topology_.nodes.size() * keys_);
    size_t leaf = 0;
    uint64_t leaf_offset = 0;
    references_.resize(topology_.nodes.size() * 4);
    for (size_t n = 0; n < topology_.nodes.size(); ++n) {
      const FurTopology::Node& node = topology_.nodes[n];
      for (size_t i = 0; i < node.child_count; ++i) {
        const FurTopology::Child& child = node.children[i];
        if (child.count == 0) {
          references_[n * 4 + i] = FurReference::to_node(child.node * node_size_);
          continue;
        }
        const bool wide = wide_[leaf++];
        references_[n * 4 + i] =
            FurReference::to_leaf(leaf_offset, static_cast<uint32_t>(block_count(child)), wide);
        write_leaf(child, wide, leaves_ + leaf_offset, &boxes_[(n * 4 + i) * keys_]);
        leaf_offset += block_count(child) * block_size(wide);
      }
    }
    // Children have larger numbers than their parents.
    for (size_t n = topology_.nodes.size(); n-- > 0;) write_node_of(n);
    return {node_boxes_.begin(), node_boxes_.begin() + static_cast<std::ptrdiff_t>(keys_)};
  }

 private:
  static size_t block_count(const FurTopology::Child& child) {
    return (child.count + FurBlockHeader::kLanes - 1) / FurBlockHeader::kLanes;
  }
  size_t block_size(bool wide) const {
    return (wide ? kWideBlock : kNarrowBlock).block(static_cast<int>(keys_));
  }

  /// Reads pieces first .. of a leaf: at most one block.
  FurBlockContents contents(const FurTopology::Child& child, size_t first) {
    FurBlockContents block;
    segments_.clear();
    const size_t count = std::min<size_t>(child.count - first, FurBlockHeader::kLanes);
    for (size_t i = 0; i < count; ++i) {
      block.numbers[i] = topology_.order[child.first + first + i].number;
      const SnappedStrands::Place place = strands_.locate(block.numbers[i]);
      for (size_t key = 0; key < keys_; ++key) {
        segments_.push_back(strands_.segment(place, static_cast<int>(key)));
      }
    }
    block.segments = segments_;
    return block;
  }

  bool is_wide(const FurTopology::Child& child) {
    for (size_t first = 0; first < child.count; first += FurBlockHeader::kLanes) {
      if (!fits_narrow_block(contents(child, first))) return true;
    }
    return false;
  }

  void write_leaf(const FurTopology::Child& child, bool wide, std::byte* out, FurBox* boxes) {
    for (size_t first = 0; first < child.count; first += FurBlockHeader::kLanes) {
      const FurBlockContents block = contents(child, first);
      write_block(block, static_cast<int>(keys_), wide, out);
      out += block_size(wide);
      for (size_t i = 0; i < block.segments.size(); ++i) {
        const uint32_t part = topology_.order[child.first + first + i / keys_].part;
        boxes[i % keys_].extend(hull(part_of(block.segments[i], part)));
      }
    }
  }

  void write_node_of(size_t n) {
    const FurTopology::Node& node = topology_.nodes[n];
    FurChild children[4];
    for (size_t i = 0; i < node.child_count; ++i) {
      const FurTopology::Child& child = node.children[i];
      const FurBox* boxes =
          child.count == 0 ? &node_boxes_[child.node * keys_] : &boxes_[(n * 4 + i) * keys_];
      children[i] = {references_[n * 4 + i], std::span(boxes, keys_)};
      for (size_t key = 0; key < keys_; ++key) node_boxes_[n * keys_ + key].extend(boxes[key]);
    }
    write_node(layout_, static_cast<int>(keys_), std::span(children, node.child_count),
               nodes_ + n * node_size_);
  }

  const SnappedStrands& strands_;
  const FurTopology& topology_;
  const FurNodeLayout layout_;
  const size_t keys_, node_size_;
  size_t node_bytes_ = 0, leaf_bytes_ = 0;
  std::byte *nodes_ = nullptr, *leaves_ = nullptr;
  std::vector<bool> wide_;                // leaf by leaf
  std::vector<FurBox> boxes_;             // of leaves: by node, child and key
  std::vector<FurBox> node_boxes_;        // by node and key
  std::vector<FurReference> references_;  // by node and child
  std::vector<SnappedSegment> segments_;
};

FurTree::FurTree(const SnappedStrands& strands, const FurTreeOptions& options) {
  view_.layout = options.layout;
  view_.motion_keys = strands.motion_keys();
  view_.step = strands.grid().step();
  view_.anchor = strands.grid().anchor();
  std::vector<FurPiece> pieces = make_pieces(strands, options.build.cuts);
  build_bytes_ = pieces.capacity() * sizeof(FurPiece);
  const FurTopology topology = build_topology(std::move(pieces), options.build);
  const size_t topology_bytes = topology.bytes();
  build_bytes_ += topology_bytes;
  if (topology.nodes.empty()) return;
  Writer writer(strands, topology, options.layout);
  writer.measure();
  node_bytes_ = writer.node_bytes();
  leaf_bytes_ = writer.leaf_bytes();
  const size_t leaves = (node_bytes_ + kNodeAlignment - 1) / kNodeAlignment * kNodeAlignment;
  block_ = PageBlock(leaves + leaf_bytes_);
  block_.prefer_large_pages();
  for (const FurBox& box : writer.write(block_.data(), block_.data() + leaves)) box_.extend(box);
  build_bytes_ =
      std::max(build_bytes_,
               topology_bytes + block_.bytes() +
                   Writer::scratch_bytes(topology.nodes.size(), static_cast<size_t>(strands.motion_keys())));
  view_.nodes = block_.data();
  view_.leaves = block_.data() + leaves;
  for (size_t axis = 0; axis < 3; ++axis) {
    view_.reach = std::max({view_.reach, std::abs(box_.low[axis]), std::abs(box_.high[axis])});
  }
}

size_t FurTree::build_bytes_bound(size_t segments, int motion_keys, const FurTreeOptions& options) {
  const size_t pieces = piece_count_bound(segments, options.build.cuts);
  const FurTopologySize size = topology_bound(pieces);
  const size_t topology = size.nodes * sizeof(FurTopology::Node) + pieces * sizeof(CurvePart);
  const size_t tree = PageBlock::held_bytes(size.nodes * node_size(options.layout, motion_keys) +
                                            kNodeAlignment + size.blocks * kWideBlock.block(motion_keys));
  return topology + std::max(pieces * sizeof(FurPiece),
                             tree + Writer::scratch_bytes(size.nodes, static_cast<size_t>(motion_keys)));
}

FurHit FurTree::closest(const Ray& ray, const FurStart& start, FurFilter* filter) const {
  return closest_fur(view_, ray, start, filter);
}

bool FurTree::occluded(const Ray& ray, const FurStart& start, FurFilter* filter) const {
  return fur_occludes(view_, ray, start, filter);
}

}  // namespace pelage
