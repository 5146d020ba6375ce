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

/// A segment or a part of a segment. `part` 1 is the whole segment. Parts 2 p and 2 p + 1 are the first and
/// the second half of part p.
struct CurvePart {
  uint32_t number = 0;
  uint32_t part = 1;
};

/// The box of a CurvePart during the build, in grid units. The last lanes of `low` and `high` identify the
/// part.
struct FurPiece {
  Four low, high;

  FurPiece() = default;
  FurPiece(const Four& box_low, const Four& box_high, CurvePart part);
  CurvePart part() const;
};

struct FurBuildOptions {
  /// Cost of visiting a node relative to testing four segments.
  float node_cost = 1.2f;
  /// Max number of additional pieces that are made by cutting long or diagonal segments, relative to the
  /// number of segments. Each piece has its own box, but a ray that visits the piece is tested against the
  /// whole segment.
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

  std::vector<Node> nodes;       ///< the root first; no nodes if there are no segments
  std::vector<CurvePart> order;  ///< the parts of all leaves, leaf by leaf

  size_t bytes() const { return nodes.capacity() * sizeof(Node) + order.capacity() * sizeof(CurvePart); }
};

/// Upper bounds of the size of a topology over a given number of pieces: the number of nodes, and the number
/// of blocks (of four segments) in all leaves.
struct FurTopologySize {
  size_t nodes, blocks;
};
FurTopologySize topology_bound(size_t pieces);

/// Returns the Bezier curve of a part of a segment. `part`: as in CurvePart.
SnappedSegment part_of(const SnappedSegment& segment, uint32_t part);

/// Returns the pieces of all segments that can be rendered (see SnappedStrands::is_drawable()). The box of a
/// piece contains the Bezier points with their radii, along the axes of `frame`. Its sides are averaged over
/// the motion keys. `cuts`: as in FurBuildOptions.
std::vector<FurPiece> make_pieces(const SnappedStrands& strands, float cuts, const FurFrame& frame);
/// Upper bound of the number of pieces for this number of segments.
inline size_t piece_count_bound(size_t segments, float cuts) {
  return segments + static_cast<size_t>(static_cast<double>(segments) * (cuts > 0 ? cuts : 0.0f));
}

/// Builds a topology with the binned surface area heuristic [Wald07]. The cost of n segments is ceil(n / 4),
/// because a block of four is tested at once. For sets of up to a few dozen segments, the cost is computed
/// exactly for every split at a multiple of four, so that nearly every lane is filled. Binary splits are
/// collapsed into 4-wide nodes. Single-threaded and deterministic.
FurTopology build_topology(std::vector<FurPiece> pieces, const FurBuildOptions& options);

}  // namespace pelage
