// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pelage {

/// Weighted reservoir sampling: chooses one item of a sequence, with a probability proportional to its mass
/// [Chao82]. Needs only one random number for the whole sequence.
class Reservoir {
 public:
  /// `u`: a random number in [0, 1).
  explicit Reservoir(float u) : u_(u) {}

  /// Offers the next item. Returns whether this item is now the chosen one. `mass`: not negative.
  bool takes(float mass) {
    if (!(mass > 0)) return false;
    sum_ += mass;
    const float share = mass / sum_;
    const bool taken = u_ < share;
    u_ = taken ? u_ / share : (u_ - share) / (1 - share);
    return taken;
  }
  /// Returns the total mass of all items so far.
  float sum() const { return sum_; }

 private:
  float u_, sum_ = 0;
};

}  // namespace pelage
