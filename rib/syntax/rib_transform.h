// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// A transform at one or more times. Between two times, the elements of the matrix are interpolated linearly,
/// so that points move on straight lines; before the first and after the last time, the transform is
/// constant. Points are row vectors: p * M.
class RibTransform {
 public:
  RibTransform() : samples_{{0.0, M44f()}} {}
  explicit RibTransform(const M44f& matrix) : samples_{{0.0, matrix}} {}
  /// Samples must be sorted by time and not empty.
  explicit RibTransform(std::vector<std::pair<double, M44f>> samples) : samples_(std::move(samples)) {}

  bool moves() const { return samples_.size() > 1; }
  size_t sample_count() const { return samples_.size(); }
  const std::vector<std::pair<double, M44f>>& samples() const { return samples_; }
  M44f at(double time) const;
  /// Returns the transform that applies `first` and then this one.
  RibTransform after(const RibTransform& first) const;
  bool operator==(const RibTransform&) const = default;

 private:
  std::vector<std::pair<double, M44f>> samples_;
};

/// Returns whether all elements are finite and the upper left 3 x 3 block has an inverse.
bool is_usable(const M44f& matrix);
/// Returns whether the matrices at all times are usable.
bool is_usable(const RibTransform& transform);

}  // namespace pelage
