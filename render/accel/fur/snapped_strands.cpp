// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/snapped_strands.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/check.h"
#include "geom/curve.h"

namespace pelage {

SnappedStrands::SnappedStrands(const Strands& strands, const FurGrid& grid)
    : strands_(strands), grid_(grid), order_(strands.strand_count()), rank_(strands.strand_count()) {
  std::iota(order_.begin(), order_.end(), 0u);
  std::stable_sort(order_.begin(), order_.end(),
                   [&](uint32_t a, uint32_t b) { return strands.id(a) < strands.id(b); });
  first_segment_.reserve(order_.size() + 1);
  uint64_t count = 0;
  bool uniform = true;
  for (uint32_t i = 0; i < order_.size(); ++i) {
    rank_[order_[i]] = i;
    first_segment_.push_back(static_cast<uint32_t>(count));
    count += pelage::segment_count(strands.basis(), strands.strand_points(order_[i]));
    uniform &= strands.strand_points(order_[i]) == strands.strand_points(order_[0]);
  }
  PELAGE_CHECK(count < UINT32_MAX);
  first_segment_.push_back(static_cast<uint32_t>(count));
  if (uniform && count > 0) segments_per_strand_ = first_segment_[1];
}

SnappedStrands::Place SnappedStrands::search(uint32_t number) const {
  const auto after = std::upper_bound(first_segment_.begin(), first_segment_.end(), number);
  const auto rank = static_cast<size_t>(after - first_segment_.begin() - 1);
  return {order_[rank], number - first_segment_[rank]};
}

SnappedSegment SnappedStrands::segment(Place place, int key) const {
  const CubicSegment curve = bezier_segment(strands_, place.strand, place.segment, key);
  const V3f leaves = smooth_tangent(place.strand, place.segment, key, curve.p[1] - curve.p[0]);
  const V3f arrives = smooth_tangent(place.strand, place.segment + 1, key, curve.p[3] - curve.p[2]);
  SnappedSegment snapped;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<size_t>(axis);
    snapped[0][a] = grid_.snap(curve.p[0][axis], axis);
    snapped[1][a] = snapped[0][a] + grid_.snap_difference(leaves[axis]);
    snapped[3][a] = grid_.snap(curve.p[3][axis], axis);
    snapped[2][a] = snapped[3][a] - grid_.snap_difference(arrives[axis]);
  }
  for (size_t i = 0; i < 4; ++i) snapped[i][3] = grid_.snap_radius(curve.r[i]);
  return snapped;
}

/// Direction from the curve's point at a joint to the next Bezier point, and from the previous one: the same
/// floats for both segments. `otherwise` at the ends, and in bases whose curves need not be smooth.
V3f SnappedStrands::smooth_tangent(uint32_t strand, uint32_t joint, int key, const V3f& otherwise) const {
  const CurveBasis basis = strands_.basis();
  if (basis == CurveBasis::kLinear || basis == CurveBasis::kBezier) return otherwise;
  const uint32_t control_point = joint + (basis == CurveBasis::kBSpline ? 1 : 0);
  if (control_point == 0 || control_point + 1 >= strands_.strand_points(strand)) return otherwise;
  const size_t point = strands_.first_point(strand) + control_point;
  return (1.0f / 6) * (strands_.point(point + 1, key) - strands_.point(point - 1, key));
}

bool SnappedStrands::is_visible(const SnappedSegment& segment) {
  for (const auto& point : segment) {
    for (float x : point) {
      if (!(std::abs(x) <= FurGrid::kReach)) return false;
    }
  }
  return true;
}

}  // namespace pelage
