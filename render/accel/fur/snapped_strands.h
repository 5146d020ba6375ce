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

/// Strands as the fur tree sees them: every segment, of whatever basis, as a cubic Bezier curve on the grid.
/// Neighbouring segments share their end point exactly, because both snap the same float; and so they do the
/// direction there where the strand is smooth, because inner points are kept as snapped differences from the
/// ends. Were inner points snapped by themselves, strands would have kinks, and ribbons, which are cut off
/// across the direction at their ends, wedges missing there. Ends are off by half a step at most, inner
/// points by a whole one.
///
/// Segments are numbered along the strands, strands in ascending order of their ids (then of their place in
/// the batch), so that of two segments the one with the smaller number stands first where distances are
/// equal. Borrows the strands. Thread safety: immutable.
class SnappedStrands {
 public:
  SnappedStrands(const Strands& strands, const FurGrid& grid);

  struct Place {
    uint32_t strand = 0;  ///< in the batch
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
  /// Calls use(number, place) for every segment in turn.
  template <class Use>
  void for_each_segment(const Use& use) const {
    for (size_t i = 0; i < order_.size(); ++i) {
      for (uint32_t n = first_segment_[i]; n < first_segment_[i + 1]; ++n) {
        use(n, Place{order_[i], n - first_segment_[i]});
      }
    }
  }
  /// Held beside the strands, for so many of them.
  static size_t bytes(size_t strands) { return 3 * sizeof(uint32_t) * (strands + 1); }
  /// Whether all numbers of a segment, at all keys, are finite and within FurGrid::kReach. Others are left
  /// out of trees: nothing meets them.
  static bool is_drawable(const SnappedSegment& segment);

 private:
  Place search(uint32_t number) const;
  V3f smooth_tangent(uint32_t strand, uint32_t joint, int key, const V3f& otherwise) const;

  const Strands& strands_;
  FurGrid grid_;
  std::vector<uint32_t> order_;          // strands by id
  std::vector<uint32_t> rank_;           // where each strand stands there
  std::vector<uint32_t> first_segment_;  // by rank, and the number of all at the end
  uint32_t segments_per_strand_ = 0;     // when all strands have equally many; otherwise 0
};

}  // namespace pelage
