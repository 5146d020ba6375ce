// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>

namespace pelage {

/// A closed interval; empty by default.
struct Range {
  float low = std::numeric_limits<float>::infinity(), high = -low;

  /// Enlarges the range so that it contains x.
  void extend(float x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  /// Enlarges the range so that it contains another one.
  void extend(const Range& o) {
    low = std::min(low, o.low);
    high = std::max(high, o.high);
  }
  /// Returns the range with both ends moved outward.
  Range widened(float by) const { return {low - by, high + by}; }
  bool is_empty() const { return !(low <= high); }
  float size() const { return high - low; }
};

}  // namespace pelage
