// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pelage {

/// Weighted reservoir sampling with one random number: chooses one of a sequence of items in proportion to
/// their masses [Chao82].
class Reservoir {
 public:
  /// `u`: a random number in [0, 1).
  explicit Reservoir(float u) : u_(u) {}

  /// Returns whether the item replaces the one chosen before. `mass`: not negative.
  bool takes(float mass) {
    if (!(mass > 0)) return false;
    sum_ += mass;
    const float share = mass / sum_;
    const bool taken = u_ < share;
    u_ = taken ? u_ / share : (u_ - share) / (1 - share);
    return taken;
  }
  /// Total mass of all items.
  float sum() const { return sum_; }

 private:
  float u_, sum_ = 0;
};

}  // namespace pelage
