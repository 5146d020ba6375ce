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

/// A segment, or a part of it: `part` is 1 for all of it; parts 2 p and 2 p + 1 are the halves of part p.
struct CurvePart {
  uint32_t number = 0;
  uint32_t part = 1;
};

/// The box of a part while a tree is built: grid units, the last lanes of both ends say what it is a box of.
struct FurPiece {
  Four low, high;

  FurPiece() = default;
  FurPiece(const Four& box_low, const Four& box_high, CurvePart part);
  CurvePart part() const;
};

struct FurBuildOptions {
  /// What visiting a node costs, in tests of four segments.
  float node_cost = 1.2f;
  /// Pieces that long or diagonal segments may be cut into beyond one, over the number of segments. Each
  /// piece has a box of its own and tests the whole segment.
  float cuts = 0;
  FurRotation rotation = FurRotation::kNever;
};

/// The shape of a fur tree, before it is written in any layout.
struct FurTopology {
  struct Child {
    uint32_t node = 0;              ///< when count is 0: index of the node
    uint32_t first = 0, count = 0;  ///< of a leaf: its parts in `order`
  };
  struct Node {
    std::array<Child, 4> children;
    uint32_t child_count = 0;
  };

  std::vector<Node> nodes;       ///< the root is the first; none for no segments
  std::vector<CurvePart> order;  ///< leaf after leaf

  size_t bytes() const { return nodes.capacity() * sizeof(Node) + order.capacity() * sizeof(CurvePart); }
};

/// How large a topology over so many pieces is at most: nodes, and blocks of four segments in its leaves.
struct FurTopologySize {
  size_t nodes, blocks;
};
FurTopologySize topology_bound(size_t pieces);

/// The Bezier curve of a part of a segment.
SnappedSegment part_of(const SnappedSegment& segment, uint32_t part);

/// The pieces of all drawable segments: boxes of their Bezier hulls in a frame, averaged over the motion
/// keys.
std::vector<FurPiece> make_pieces(const SnappedStrands& strands, float cuts, const FurFrame& frame);
/// At least their number, for so many segments.
inline size_t piece_count_bound(size_t segments, float cuts) {
  return segments + static_cast<size_t>(static_cast<double>(segments) * (cuts > 0 ? cuts : 0.0f));
}

/// Builds by binned surface areas [Wald07], where n segments cost as many tests as there are fours in them;
/// sets of a few dozens are swept exactly, and cut at multiples of four only, so that nearly every lane is
/// filled. Binary splits are collapsed into nodes of four. By the calling thread alone; the same for the same
/// input.
FurTopology build_topology(std::vector<FurPiece> pieces, const FurBuildOptions& options);

}  // namespace pelage
