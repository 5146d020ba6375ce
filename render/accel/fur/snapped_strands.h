// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/strands.h"
#include "render/accel/fur/fur_grid.h"

namespace pelage {

/// One segment at one motion key in grid units: Bezier points as x, y, z, radius.
using SnappedSegment = std::array<std::array<float, 4>, 4>;

/// Strands as stored in the fur tree: every segment, of whatever basis, as a cubic Bezier curve on the grid.
/// Neighbouring segments share their end point exactly, because both snap the same float. Where the strand is
/// smooth they also share the tangent, because inner points are stored as snapped differences from the ends.
/// If inner points were snapped independently, strands would have kinks. Ribbons are cut perpendicular to the
/// tangent at their ends, so they would have wedge-shaped gaps at the kinks. The error is at most half a step
/// for end points, and one step for inner points.
///
/// Segments are numbered along the strands, strands in ascending order of their ids (then of their index in
/// the batch). Of two segments at equal distance, the one with the smaller number therefore comes first.
/// Refers to the strands. Thread safety: immutable.
class SnappedStrands {
 public:
  SnappedStrands(const Strands& strands, const FurGrid& grid);

  struct Place {
    uint32_t strand = 0;  ///< index in the batch
    uint32_t segment = 0;
  };

  const FurGrid& grid() const { return grid_; }
  int motion_keys() const { return strands_.motion_keys(); }
  uint32_t segment_count() const { return first_segment_.back(); }
  Place locate(uint32_t number) const {
    if (segments_per_strand_ == 0) return search(number);
    const uint32_t rank = number / segments_per_strand_;
    return {order_[rank], number - rank * segments_per_strand_};
  }
  /// The number of a strand's first segment.
  uint32_t first_segment(uint32_t strand) const { return first_segment_[rank_[strand]]; }
  SnappedSegment segment(Place place, int key) const;
  /// Calls use(number, place) for every segment in order.
  template <class Use>
  void for_each_segment(const Use& use) const {
    for (size_t i = 0; i < order_.size(); ++i) {
      for (uint32_t n = first_segment_[i]; n < first_segment_[i + 1]; ++n) {
        use(n, Place{order_[i], n - first_segment_[i]});
      }
    }
  }
  /// Memory in addition to the strands, for this number of them.
  static size_t bytes(size_t strands) { return 3 * sizeof(uint32_t) * (strands + 1); }
  /// Whether all numbers of a segment, at all keys, are finite and within FurGrid::kReach. Other segments are
  /// omitted from trees and never hit.
  static bool is_drawable(const SnappedSegment& segment);

 private:
  Place search(uint32_t number) const;
  V3f smooth_tangent(uint32_t strand, uint32_t joint, int key, const V3f& otherwise) const;

  const Strands& strands_;
  FurGrid grid_;
  std::vector<uint32_t> order_;          // strands by id
  std::vector<uint32_t> rank_;           // index of each strand in that order
  std::vector<uint32_t> first_segment_;  // by rank; the last entry is the total number
  uint32_t segments_per_strand_ = 0;     // when all strands have the same number; otherwise 0
};

}  // namespace pelage
