// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace pelage {

/// The linear map from the points of a pinned B-spline to the points of another one with fewer points. The
/// result is the closest such curve, in the mean over the parameter. Memory and construction time are linear
/// in the number of points. Immutable.
class PointFit {
 public:
  /// 4 <= to < from.
  PointFit(size_t from, size_t to);

  size_t to() const { return to_; }

  /// Weights of the old points for each new point, row by row. The first and the last point are kept.
  std::span<const float> curve(size_t row) const { return std::span(curve_).subspan(row * from_, from_); }
  /// The same for values that are linear between points.
  std::span<const float> values(size_t row) const { return std::span(values_).subspan(row * from_, from_); }
  /// Whether the new curve, at evenly spaced parameters, stays within `tolerance` of the old one. `points`: 4
  /// floats each, of which the first 3 are used.
  bool stays_within(const float* points, float tolerance) const;
  /// Heap memory.
  size_t bytes() const { return (curve_.size() + values_.size() + error_.size()) * sizeof(float); }

 private:
  bool matrix_stays_within(const float* points, float limit) const;
  bool curves_stay_within(const float* points, float limit) const;

  size_t from_, to_;
  std::vector<float> curve_, values_;
  std::vector<float> error_;  // for few points: new minus old curve, as weights of the old points
};

}  // namespace pelage
