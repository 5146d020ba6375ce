// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/four_lanes.h"
#include "render/accel/fur/fur_frame.h"
#include "render/accel/fur/snapped_strands.h"

namespace pelage {

/// The box of a segment during the build, in grid units. The last lane of `low` holds the segment's number.
struct FurPiece {
  Four low, high;

  FurPiece() = default;
  FurPiece(const Four& box_low, const Four& box_high, uint32_t number);
  uint32_t number() const;
};

struct FurBuildOptions {
  /// Cost of visiting a node relative to testing four segments.
  float node_cost = 1.2f;
  FurRotation rotation = FurRotation::kNever;
};

/// The structure of a fur tree.
struct FurTopology {
  struct Child {
    uint32_t node = 0;              ///< index of the child node, if count is 0
    uint32_t first = 0, count = 0;  ///< for a leaf: range of its segments in `order`
  };
  struct Node {
    std::array<Child, 4> children;
    uint32_t child_count = 0;
  };

  std::vector<Node> nodes;      ///< the root first; no nodes if there are no segments
  std::vector<uint32_t> order;  ///< the segment numbers of all leaves, leaf by leaf

  size_t bytes() const { return nodes.capacity() * sizeof(Node) + order.capacity() * sizeof(uint32_t); }
};

/// Upper bounds of the size of a topology over a given number of pieces: the number of nodes, and the number
/// of blocks (of four segments) in all leaves.
struct FurTopologySize {
  size_t nodes, blocks;
};
FurTopologySize topology_bound(size_t pieces);

/// Returns the pieces of all segments that can be rendered (see SnappedStrands::is_visible()). The box of a
/// piece contains the Bezier points with their radii, along the axes of `frame`. Its sides are averaged over
/// the motion keys.
std::vector<FurPiece> make_pieces(const SnappedStrands& strands, const FurFrame& frame);

/// Builds a topology with the binned surface area heuristic [Wald07]. The cost of n segments is ceil(n / 4),
/// because a block of four is tested at once. For sets of up to a few dozen segments, the cost is computed
/// exactly for every split at a multiple of four, so that nearly every lane is filled. Binary splits are
/// collapsed into 4-wide nodes. Single-threaded and deterministic.
FurTopology build_topology(std::vector<FurPiece> pieces, const FurBuildOptions& options);

}  // namespace pelage
