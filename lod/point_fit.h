// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace pelage {

/// A linear map from the control points of a pinned B-spline to the control points of one with fewer points.
/// The new curve has the smallest mean squared distance from the old curve at equal parameters. Memory and
/// construction time are linear in `from`. Immutable.
class PointFit {
 public:
  /// `from`, `to`: number of points of the old and the new curve; 4 <= to < from.
  PointFit(size_t from, size_t to);

  size_t to() const { return to_; }

  /// Returns the weights of all old points in new point `row`. The first and the last point stay the same.
  std::span<const float> curve(size_t row) const { return std::span(curve_).subspan(row * from_, from_); }
  /// Returns the weights of the values at all old points in the value at new point `row`, for values that are
  /// interpolated linearly between points.
  std::span<const float> values(size_t row) const { return std::span(values_).subspan(row * from_, from_); }
  /// Returns whether the new curve is within `tolerance` of the old curve at each of many evenly spaced
  /// parameters. `points`: the old points, 4 floats each, of which the first 3 are the position.
  bool stays_within(const float* points, float tolerance) const;
  /// Heap memory.
  size_t bytes() const { return (curve_.size() + values_.size() + error_.size()) * sizeof(float); }

 private:
  bool matrix_stays_within(const float* points, float limit) const;
  bool curves_stay_within(const float* points, float limit) const;

  size_t from_, to_;
  std::vector<float> curve_, values_;
  std::vector<float> error_;  // weights of the old points in new curve minus old curve; empty for many points
};

}  // namespace pelage
