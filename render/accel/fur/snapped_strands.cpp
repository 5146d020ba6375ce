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
  SnappedSegment snapped;
  for (size_t i = 0; i < 4; ++i) {
    for (int axis = 0; axis < 3; ++axis)
      snapped[i][static_cast<size_t>(axis)] = grid_.snap(curve.p[i][axis], axis);
    snapped[i][3] = grid_.snap_radius(curve.r[i]);
  }
  return snapped;
}

bool SnappedStrands::is_drawable(const SnappedSegment& segment) {
  for (const auto& point : segment) {
    for (float x : point) {
      if (!(std::abs(x) <= FurGrid::kReach)) return false;
    }
  }
  return true;
}

}  // namespace pelage
