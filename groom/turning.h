// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "groom/operator.h"
#include "groom/rotation.h"
#include "groom/strand_batch.h"

namespace pelage {

// Rotating the segments of strands by angles that increase along the strand preserves the length of every
// segment.

/// Fraction of the rotation reached along the arc: 0 until `start`, then up to 1 at `end`, following a power
/// function with exponent `profile`. 0 <= start <= end <= 1; start = end rotates all at once.
struct TurnProfile {
  float start = 0;
  float end = 1;
  float profile = 1;

  /// Mean over the range [from, to] of the arc.
  float mean(float from, float to) const;
};

/// Rotates every segment of strand `s` by `rotation` times the mean of the profile over that segment, then
/// reassembles the strand.
void turn_strand(StrandBatch& batch, size_t s, const TurnProfile& profile, const Rotation& rotation);

/// Upper bound of the distance by which any point of a strand moves when the segments are rotated by at most
/// `angle` times the profile. A rotation by a moves the end of a segment by 2 sin(a / 2) times the length of
/// the segment. This function is concave in a, so by Jensen's inequality the sum over any partition is at
/// most the value for the mean angle.
float turn_bound(const StrandReach& before, const TurnProfile& profile, float angle);

}  // namespace pelage
