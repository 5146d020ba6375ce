// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace pelage {

/// The linear map from the points of a pinned B-spline to those of another with fewer points that comes
/// closest to it, in the mean over the parameter. Immutable.
class PointFit {
 public:
  /// 4 <= to < from.
  PointFit(size_t from, size_t to);

  size_t to() const { return to_; }

  /// New points: sums over the old ones with these weights, row by row. The first and the last are kept.
  std::span<const float> curve(size_t row) const { return std::span(curve_).subspan(row * from_, from_); }
  /// The same for values that are linear between points.
  std::span<const float> values(size_t row) const { return std::span(values_).subspan(row * from_, from_); }
  /// New minus old curve at even parameters, as sums over the old points.
  size_t error_rows() const { return error_.size() / from_; }
  std::span<const float> error(size_t row) const { return std::span(error_).subspan(row * from_, from_); }

 private:
  size_t from_, to_;
  std::vector<float> curve_, values_, error_;
};

}  // namespace pelage
