// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "groom/operators/operator.h"
#include "groom/strands/rotation.h"
#include "groom/strands/strand_batch.h"

namespace pelage {

// Rotation of the segments of a strand by angles that increase along the strand. It preserves the length of
// every segment.

/// Returns 0 up to x = 0 and 1 from x = 1 on, with a smooth transition.
inline float smooth_step(float x) {
  x = std::clamp(x, 0.0f, 1.0f);
  return x * x * (3 - 2 * x);
}

/// Fraction of the full angle by which a segment is rotated, as a function of its position along the arc (0
/// root, 1 tip). It is 0 up to `start` and 1 from `end` on. In between, it rises as a power function with the
/// exponent `profile`. 0 <= start <= end <= 1. If start = end, it jumps from 0 to 1 there.
struct TurnProfile {
  float start = 0;
  float end = 1;
  float profile = 1;

  /// Returns the mean of the fraction over the range [from, to] of the arc.
  float mean(float from, float to) const;
};

/// Rotates every segment of strand `s` by `rotation` times the mean of the profile over this segment. Joins
/// the rotated segments from the root on.
void turn_strand(StrandBatch& batch, size_t s, const TurnProfile& profile, const Rotation& rotation);

}  // namespace pelage
