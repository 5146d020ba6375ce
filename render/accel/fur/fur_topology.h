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

/// A segment or a part of it: `part` 1 is the whole; parts 2 p and 2 p + 1 are the halves of part p.
struct CurvePart {
  uint32_t number = 0;
  uint32_t part = 1;
};

/// The box of a part during the build, in grid units. The last lanes of `low` and `high` identify the part.
struct FurPiece {
  Four low, high;

  FurPiece() = default;
  FurPiece(const Four& box_low, const Four& box_high, CurvePart part);
  CurvePart part() const;
};

struct FurBuildOptions {
  /// Cost of visiting a node relative to testing four segments.
  float node_cost = 1.2f;
  /// Max number of additional pieces from cutting long or diagonal segments, relative to the number of
  /// segments. Each piece has its own box and tests the whole segment.
  float cuts = 0;
  FurRotation rotation = FurRotation::kNever;
};

/// The structure of a fur tree, independent of the node layout.
struct FurTopology {
  struct Child {
    uint32_t node = 0;              ///< index of the child node, if count is 0
    uint32_t first = 0, count = 0;  ///< for a leaf: range of its parts in `order`
  };
  struct Node {
    std::array<Child, 4> children;
    uint32_t child_count = 0;
  };

  std::vector<Node> nodes;       ///< the root is the first; empty without segments
  std::vector<CurvePart> order;  ///< leaf by leaf

  size_t bytes() const { return nodes.capacity() * sizeof(Node) + order.capacity() * sizeof(CurvePart); }
};

/// Upper bounds for a topology over this number of pieces: nodes, and blocks of four segments in its leaves.
struct FurTopologySize {
  size_t nodes, blocks;
};
FurTopologySize topology_bound(size_t pieces);

/// The Bezier curve of a part of a segment.
SnappedSegment part_of(const SnappedSegment& segment, uint32_t part);

/// The pieces of all segments that can be rendered: boxes of their Bezier hulls in a frame, averaged over the
/// motion keys.
std::vector<FurPiece> make_pieces(const SnappedStrands& strands, float cuts, const FurFrame& frame);
/// Upper bound of the number of pieces for this number of segments.
inline size_t piece_count_bound(size_t segments, float cuts) {
  return segments + static_cast<size_t>(static_cast<double>(segments) * (cuts > 0 ? cuts : 0.0f));
}

/// Builds with the binned surface area heuristic [Wald07]; n segments cost as much as ceil(n / 4) tests. Sets
/// of up to a few dozen segments are swept exactly and split only at multiples of four, so that nearly every
/// lane is filled. Binary splits are collapsed into 4-wide nodes. Single-threaded and deterministic.
FurTopology build_topology(std::vector<FurPiece> pieces, const FurBuildOptions& options);

}  // namespace pelage
