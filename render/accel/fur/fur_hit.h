// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "render/accel/accel.h"

namespace pelage {

/// The position on a strand from which a ray starts. Near this position the ray ignores this strand, so
/// neither the ribbon's rotation towards the ray nor rounding causes a self-intersection.
struct FurStart {
  uint32_t first_segment = 0,
           segment_count = 0;  ///< range of the strand's segment numbers; count 0: no strand
  float place = 0;             ///< index of the segment in the strand + curve parameter in that segment
};

/// Intersection of a ray with a segment.
struct FurHit {
  static constexpr uint32_t kNone = ~0u;

  float distance = std::numeric_limits<float>::infinity();  ///< grid units inside a tree, scene units outside
  uint32_t number = kNone;                                  ///< segment number as in SnappedStrands
  float u = 0;                                              ///< curve parameter in the segment, in (0, 1]
  float h = 0;                                              ///< offset across the strand, as Hit::v

  explicit operator bool() const { return number != kNone; }
};

/// Decides which hits a query accepts. A query may call accepts() in any order of hits, and several times for
/// the same hit. Distances of these hits are in scene units.
class FurFilter {
 public:
  virtual ~FurFilter() = default;
  virtual bool accepts(const FurHit& hit) = 0;
};

}  // namespace pelage
