// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/guide_turns.h"

#include <cstddef>

#include "base/check.h"

namespace pelage {

GuideTurns blend_turns(GuideTurns turns, const GuideTurns& next, float t) {
  PELAGE_CHECK(turns.size() == next.size());
  for (size_t i = 0; i < turns.size(); i += 4) {
    float* a = &turns[i];
    const float* b = &next[i];
    // A quaternion and its negative are the same rotation.
    const float sign = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] < 0 ? -1.0f : 1.0f;
    for (size_t k = 0; k < 4; ++k) a[k] = a[k] * (1 - t) + sign * b[k] * t;
  }
  return turns;
}

}  // namespace pelage
