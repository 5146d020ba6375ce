// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pelage {

/// Systematic sampling: passes over items in order, and chooses them in proportion to their masses. An item
/// of mass m is chosen floor(m / step) or ceil(m / step) times, and m / step times on average. The same holds
/// for every run of consecutive items, where m is the sum of their masses.
class SystematicChoice {
 public:
  /// `step`: positive. `u`: a random number in [0, 1).
  SystematicChoice(double step, double u) : step_(step), next_(u * step) {}

  /// Returns how often the next item is chosen. `mass`: not negative.
  uint32_t times(double mass) {
    sum_ += mass;
    uint32_t chosen = 0;
    for (; next_ < sum_; next_ += step_) ++chosen;
    return chosen;
  }
  double step() const { return step_; }

 private:
  double step_, next_, sum_ = 0;
};

}  // namespace pelage
