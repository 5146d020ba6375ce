// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace pelage {

/// The linear map from the points of a pinned B-spline to those of another with fewer points that comes
/// closest to it, in the mean over the parameter. What it holds and takes to make grows with the number of
/// points, not with its square. Immutable.
class PointFit {
 public:
  /// 4 <= to < from.
  PointFit(size_t from, size_t to);

  size_t to() const { return to_; }

  /// New points: sums over the old ones with these weights, row by row. The first and the last are kept.
  std::span<const float> curve(size_t row) const { return std::span(curve_).subspan(row * from_, from_); }
  /// The same for values that are linear between points.
  std::span<const float> values(size_t row) const { return std::span(values_).subspan(row * from_, from_); }
  /// Whether the new curve is nowhere, at even parameters, farther than `tolerance` from the old one, whose
  /// points are `points`: 4 floats each, of which the first 3 count.
  bool stays_within(const float* points, float tolerance) const;
  /// Of the heap.
  size_t bytes() const { return (curve_.size() + values_.size() + error_.size()) * sizeof(float); }

 private:
  bool matrix_stays_within(const float* points, float limit) const;
  bool curves_stay_within(const float* points, float limit) const;

  size_t from_, to_;
  std::vector<float> curve_, values_;
  std::vector<float> error_;  // of few points: new minus old curve, as sums over the old points
};

}  // namespace pelage
