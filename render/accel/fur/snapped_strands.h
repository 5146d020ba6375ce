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

/// Converts strands to the form in which a fur tree stores them: every segment, whatever its basis, becomes a
/// cubic Bezier curve whose points are on the grid. Consecutive segments share their end point exactly,
/// because both snap the same float. Where the strand is smooth, they also share the tangent, because inner
/// points are stored as snapped differences from the end points. If inner points were snapped independently,
/// strands would have kinks. At each kink there would be a wedge-shaped gap, because ribbons end
/// perpendicular to their tangent. Along each axis, snapping moves an end point by at most half a step, and
/// an inner point by at most one step.
///
/// Segments are numbered consecutively along each strand. The strands are in ascending order of their ids;
/// strands with the same id are in the order of their indices in the batch. Of two hits at the same distance,
/// the hit on the segment with the smaller number comes first, so the numbers break ties by strand id. Keeps
/// a reference to the strands. Thread safety: immutable.
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
  /// Returns the number of a strand's first segment.
  uint32_t first_segment(uint32_t strand) const { return first_segment_[rank_[strand]]; }
  SnappedSegment segment(Place place, int key) const;
  /// Calls use(number, place) for every segment in ascending order of numbers.
  template <class Use>
  void for_each_segment(const Use& use) const {
    for (size_t i = 0; i < order_.size(); ++i) {
      for (uint32_t n = first_segment_[i]; n < first_segment_[i + 1]; ++n) {
        use(n, Place{order_[i], n - first_segment_[i]});
      }
    }
  }
  /// Bytes of memory for `strands` strands, in addition to the strands themselves.
  static size_t bytes(size_t strands) { return 3 * sizeof(uint32_t) * (strands + 1); }
  /// Whether all coordinates and radii of a segment at one key are finite and within FurGrid::kReach. A
  /// segment for which this is false at any key is omitted from trees and never hit.
  static bool is_visible(const SnappedSegment& segment);

 private:
  Place search(uint32_t number) const;
  V3f smooth_tangent(uint32_t strand, uint32_t joint, int key, const V3f& otherwise) const;

  const Strands& strands_;
  FurGrid grid_;
  std::vector<uint32_t> order_;          // strands by id
  std::vector<uint32_t> rank_;           // index of each strand in that order
  std::vector<uint32_t> first_segment_;  // by rank; the last entry is the number of segments
  uint32_t segments_per_strand_ = 0;     // if all strands have the same number; otherwise 0
};

}  // namespace pelage
