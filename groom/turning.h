// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "groom/operator.h"
#include "groom/rotation.h"
#include "groom/strand_batch.h"

namespace pelage {

// Turning the segments of strands by angles that grow along the strand keeps every segment's length.

/// How far along its arc a strand has turned: 0 until `start`, then up to 1 at `end` like the power `profile`
/// of the way from one to the other. 0 <= start <= end <= 1; start = end turns all at once.
struct TurnProfile {
  float start = 0;
  float end = 1;
  float profile = 1;

  /// Mean over the part [from, to] of the arc.
  float mean(float from, float to) const;
};

/// Turns every segment of strand `s` by `rotation` times the mean of the profile over that segment, then puts
/// the strand together again.
void turn_strand(StrandBatch& batch, size_t s, const TurnProfile& profile, const Rotation& rotation);

/// Bound on how far any point of a strand moves when its segments are turned by at most `angle` times the
/// profile. A segment moves its end by 2 sin(a / 2) of its length; that is concave in a, so by Jensen's
/// inequality the sum over any partition is at most that of the mean angle.
float turn_bound(const StrandReach& before, const TurnProfile& profile, float angle);

}  // namespace pelage
