// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_tree.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/error.h"
#include "render/accel/fur/fur_leaf.h"
#include "render/accel/fur/fur_ray.h"

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

/// Writes a topology. Nodes are in depth-first order, and so are leaves; the leaves of one node are adjacent.
class FurTree::Writer {
 public:
  Writer(const SnappedStrands& strands, const FurTopology& topology, const FurFrame& frame)
      : strands_(strands),
        topology_(topology),
        frame_(frame),
        keys_(static_cast<size_t>(strands.motion_keys())),
        node_bytes_(topology.nodes.size() * FurQuantisedNode::size(strands.motion_keys())),
        wide_(topology.nodes.size() * 4) {}

  /// Offset of the leaves.
  size_t leaves() const { return leaves_offset(node_bytes_); }
  size_t node_bytes() const { return node_bytes_; }
  size_t leaf_bytes() const { return leaf_bytes_; }
  /// Temporary memory for this number of nodes.
  static size_t scratch_bytes(size_t nodes, size_t keys) {
    return nodes * (4 * keys * sizeof(FurBox) + keys * sizeof(FurBox) + 4 * sizeof(FurReference) + 1) +
           FurBlockHeader::kLanes * keys * sizeof(SnappedSegment);
  }

  /// Writes the nodes followed by the leaves. All leaves are assumed narrow at first; wide ones are found
  /// when they are written, and then everything is written again.
  PageBlock write(PagePool* pool) {
    while (true) {
      place_leaves();
      PageBlock block = make_block(pool, leaves() + leaf_bytes_);
      if (write_leaves(block.data() + leaves())) {
        write_nodes(block.data());
        return block;
      }
    }
  }
  /// Boxes of the whole tree in its frame, one per key.
  std::span<const FurBox> boxes() const { return std::span(node_boxes_).first(keys_); }
  /// The box of the whole tree along the grid's axes.
  const FurBox& whole() const { return whole_; }

 private:
  static size_t block_count(const FurTopology::Child& child) {
    return (child.count + FurBlockHeader::kLanes - 1) / FurBlockHeader::kLanes;
  }
  void place_leaves() {
    references_.assign(topology_.nodes.size() * 4, {});
    leaf_bytes_ = 0;
    for (size_t n = 0; n < topology_.nodes.size(); ++n) {
      const FurTopology::Node& node = topology_.nodes[n];
      for (size_t i = 0; i < node.child_count; ++i) {
        const FurTopology::Child& child = node.children[i];
        if (child.count == 0) {
          references_[n * 4 + i] =
              FurReference::to_node(child.node * FurQuantisedNode::size(strands_.motion_keys()));
          continue;
        }
        const bool wide = wide_[n * 4 + i];
        references_[n * 4 + i] =
            FurReference::to_leaf(leaf_bytes_, static_cast<uint32_t>(block_count(child)), wide);
        leaf_bytes_ += block_count(child) * block_size(wide);
      }
    }
    if (node_bytes_ > FurReference::kNodeReach || leaf_bytes_ > FurReference::kLeafReach)
      throw Error(ErrorKind::kMemory, "one fur tree would need more than 4 GiB; reduce leaf_strands");
  }

  /// False when leaves with space for narrow blocks turned out to be wide.
  bool write_leaves(std::byte* leaves) {
    boxes_.assign(topology_.nodes.size() * 4 * keys_, {});
    bool all_fit = true;
    for (size_t n = 0; n < topology_.nodes.size(); ++n) {
      const FurTopology::Node& node = topology_.nodes[n];
      for (size_t i = 0; i < node.child_count; ++i) {
        if (node.children[i].count == 0) continue;
        const FurReference leaf = references_[n * 4 + i];
        if (write_leaf(node.children[i], leaf.is_wide(), leaves + leaf.leaf_offset(),
                       &boxes_[(n * 4 + i) * keys_]))
          continue;
        wide_[n * 4 + i] = true;
        all_fit = false;
      }
    }
    return all_fit;
  }

  void write_nodes(std::byte* nodes) {
    node_boxes_.resize(topology_.nodes.size() * keys_);
    // Children have larger numbers than their parents.
    for (size_t n = topology_.nodes.size(); n-- > 0;) write_node_of(n, nodes);
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
      block.numbers[i] = topology_.order[child.first + first + i];
      const SnappedStrands::Place place = strands_.locate(block.numbers[i]);
      for (size_t key = 0; key < keys_; ++key) {
        segments_.push_back(strands_.segment(place, static_cast<int>(key)));
      }
    }
    block.segments = segments_;
    return block;
  }

  /// False when the leaf should be narrow but cannot represent its segments.
  bool write_leaf(const FurTopology::Child& child, bool wide, std::byte* out, FurBox* boxes) {
    for (size_t first = 0; first < child.count; first += FurBlockHeader::kLanes) {
      const FurBlockContents block = contents(child, first);
      if (!wide && !fits_narrow_block(block)) return false;
      write_block(block, static_cast<int>(keys_), wide, out);
      out += block_size(wide);
      for (size_t i = 0; i < block.segments.size(); ++i) {
        const SnappedSegment& curve = block.segments[i];
        boxes[i % keys_].extend(hull(frame_(curve)));
        whole_.extend(hull(curve));
      }
    }
    return true;
  }

  void write_node_of(size_t n, std::byte* nodes) {
    const FurTopology::Node& node = topology_.nodes[n];
    FurChild children[4];
    for (size_t i = 0; i < node.child_count; ++i) {
      const FurTopology::Child& child = node.children[i];
      const FurBox* boxes =
          child.count == 0 ? &node_boxes_[child.node * keys_] : &boxes_[(n * 4 + i) * keys_];
      children[i] = {references_[n * 4 + i], std::span(boxes, keys_)};
      for (size_t key = 0; key < keys_; ++key) node_boxes_[n * keys_ + key].extend(boxes[key]);
    }
    write_node(static_cast<int>(keys_), std::span(children, node.child_count),
               nodes + n * FurQuantisedNode::size(strands_.motion_keys()));
  }

  const SnappedStrands& strands_;
  const FurTopology& topology_;
  const FurFrame& frame_;
  const size_t keys_, node_bytes_;
  size_t leaf_bytes_ = 0;
  std::vector<bool> wide_;          // of leaves: by node and child
  std::vector<FurBox> boxes_;       // of leaves: by node, child and key
  std::vector<FurBox> node_boxes_;  // by node and key
  FurBox whole_;
  std::vector<FurReference> references_;  // by node and child
  std::vector<SnappedSegment> segments_;
};

PageBlock FurTree::make_block(PagePool* pool, size_t bytes) {
  if (pool) return pool->take(bytes);
  PageBlock block(bytes);
  block.prefer_large_pages();
  return block;
}

FurTree::FurTree(const SnappedStrands& strands, const FurTreeOptions& options) {
  view_.motion_keys = strands.motion_keys();
  view_.step = strands.grid().step();
  view_.anchor = strands.grid().anchor();
  view_.frame = choose_frame(strands, options.build.rotation);
  std::vector<FurPiece> pieces = make_pieces(strands, view_.frame);
  build_bytes_ = pieces.capacity() * sizeof(FurPiece);
  const FurTopology topology = build_topology(std::move(pieces), options.build);
  const size_t topology_bytes = topology.bytes();
  build_bytes_ += topology_bytes;
  if (topology.nodes.empty()) return;
  Writer writer(strands, topology, view_.frame);
  block_ = writer.write(options.pool);
  node_bytes_ = writer.node_bytes();
  leaf_bytes_ = writer.leaf_bytes();
  box_ = writer.whole();
  FurBox all = box_;
  for (const FurBox& box : writer.boxes()) all.extend(box);
  build_bytes_ =
      std::max(build_bytes_,
               topology_bytes + block_.bytes() +
                   Writer::scratch_bytes(topology.nodes.size(), static_cast<size_t>(strands.motion_keys())));
  view_.nodes = block_.data();
  view_.leaves = block_.data() + writer.leaves();
  for (size_t axis = 0; axis < 3; ++axis) {
    view_.reach = std::max({view_.reach, std::abs(all.low[axis]), std::abs(all.high[axis])});
  }
}

size_t FurTree::build_bytes_bound(size_t segments, int motion_keys) {
  // The samples for choosing a frame are freed before and never take as much memory.
  const FurTopologySize size = topology_bound(segments);
  const size_t topology = size.nodes * sizeof(FurTopology::Node) + segments * sizeof(uint32_t);
  const size_t tree = PageBlock::held_bytes(size.nodes * FurQuantisedNode::size(motion_keys) +
                                            kNodeAlignment + size.blocks * kWideBlock.block(motion_keys));
  return topology + std::max(segments * sizeof(FurPiece),
                             tree + Writer::scratch_bytes(size.nodes, static_cast<size_t>(motion_keys)));
}

FurTree::FurTree(const FurTreeView& like, const FurBox& box, PageBlock block, size_t node_bytes,
                 size_t leaf_bytes)
    : block_(std::move(block)), node_bytes_(node_bytes), leaf_bytes_(leaf_bytes), view_(like), box_(box) {
  view_.nodes = node_bytes > 0 ? block_.data() : nullptr;
  view_.leaves = node_bytes > 0 ? block_.data() + leaves_offset(node_bytes) : nullptr;
}

size_t FurTree::leaves_offset(size_t node_bytes) {
  return (node_bytes + kNodeAlignment - 1) / kNodeAlignment * kNodeAlignment;
}

FurHit FurTree::closest(const Ray& ray, const FurStart& start, FurFilter* filter) const {
  return closest_fur(view_, ray, start, filter);
}

bool FurTree::occluded(const Ray& ray, const FurStart& start, FurFilter* filter) const {
  return fur_occludes(view_, ray, start, filter);
}

FurHit closest_fur(const FurTreeView& tree, const Ray& ray, const FurStart& start, FurFilter* filter) {
  FurRay prepared;
  if (!tree.nodes || !prepared.prepare(tree, ray, start)) return {};
  return closest_fur(tree, prepared, filter);
}

bool fur_occludes(const FurTreeView& tree, const Ray& ray, const FurStart& start, FurFilter* filter) {
  FurRay prepared;
  if (!tree.nodes || !prepared.prepare(tree, ray, start)) return false;
  return fur_occludes(tree, prepared, filter);
}

}  // namespace pelage
