// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cmath>

#include "geom/four_lanes.h"
#include "groom/strands/root_grid.h"
#include "groom/strands/strand_batch.h"

namespace pelage {

/// Finds the nearest points of a RootGrid for many strands. Where the strands stand close together, it
/// collects the points around all of them once, which takes less time. The results are those of
/// RootGrid::nearest_if().
class NearRoots {
 public:
  /// `wanted`: max number of points per strand, at least 1. `grid` must outlive the object.
  NearRoots(const RootGrid& grid, int wanted) : grid_(grid), wanted_(wanted) {}

  /// Collects the points around the first `count` strands.
  void collect(const RootRows& roots, size_t count);
  template <class Accept>
  int nearest_if(const V3f& position, const V3f& normal, RootGrid::Neighbour* result,
                 const Accept& accept) const;

 private:
  static constexpr size_t kMaxPoints = 128;
  using Row = std::array<float, kMaxPoints>;

  static Four four_of(const Row& row, size_t first) { return load_four(&row[first]); }

  const RootGrid& grid_;
  const int wanted_;
  size_t count_ = 0;  // of the points that are collected; 0: none are, search the grid
  V3f centre_{0};
  float distance_ = 0;  // all points within this distance from the centre are collected
  std::array<uint32_t, kMaxPoints> index_;
  std::array<Row, 3> position_, normal_;
};

template <class Accept>
int NearRoots::nearest_if(const V3f& position, const V3f& normal, RootGrid::Neighbour* result,
                          const Accept& accept) const {
  int count = 0;
  float far = grid_.radius() * grid_.radius();  // squared distance beyond which no point is wanted
  const FourVectors at{four(position.x), four(position.y), four(position.z)};
  const FourVectors up{four(normal.x), four(normal.y), four(normal.z)};
  for (size_t first = 0; first < count_; first += 4) {
    const FourVectors d = FourVectors{four_of(position_[0], first), four_of(position_[1], first),
                                      four_of(position_[2], first)} -
                          at;
    const FourVectors n{four_of(normal_[0], first), four_of(normal_[1], first), four_of(normal_[2], first)};
    const Four distance2 = d.dot(d), cosine = n.dot(up);
    const auto wanted = (distance2 <= four(far)) & (cosine >= four(RootGrid::kMinCosine));
    for (uint32_t lanes = lane_bits(wanted); lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<uint32_t>(std::countr_zero(lanes));
      const RootGrid::Neighbour candidate{index_[first + lane], std::sqrt(distance2[lane])};
      if (count == wanted_ && !RootGrid::before(candidate, result[count - 1])) continue;
      if (!accept(candidate.index)) continue;
      RootGrid::insert(candidate, wanted_, result, count);
      if (count == wanted_) far = RootGrid::farthest(result[count - 1].distance);
    }
  }
  // Points that are not collected are farther from the centre, and so from this place.
  const float safe = (distance_ - (position - centre_).length()) * 0.9999f;
  if (count == wanted_ && result[count - 1].distance < safe) return count;
  return grid_.nearest_if(position, normal, wanted_, result, accept);
}

}  // namespace pelage
