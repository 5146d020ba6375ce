// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "render/accel/accel.h"

namespace pelage {

/// The place on a strand that a ray starts from. Near it the same strand is not met: neither the ribbon's own
/// turning towards the ray nor rounding counts as a hit.
struct FurStart {
  uint32_t first_segment = 0, segment_count = 0;  ///< numbers of the strand's segments; count 0: no strand
  float place = 0;                                ///< segment of the strand + parameter in it
};

/// Where a ray meets a segment.
struct FurHit {
  static constexpr uint32_t kNone = ~0u;

  float distance = std::numeric_limits<float>::infinity();  ///< grid units inside a tree, scene units outside
  uint32_t number = kNone;                                  ///< of the segment, as SnappedStrands counts
  float u = 0;                                              ///< along the segment, in (0, 1]
  float h = 0;                                              ///< across it, as Hit::v

  explicit operator bool() const { return number != kNone; }
  /// Nearer, or as near and of the smaller number.
  bool precedes(const FurHit& o) const {
    return distance != o.distance ? distance < o.distance : number < o.number;
  }
};

/// What rays cost.
struct FurTests {
  int64_t boxes = 0;     ///< four per node
  int64_t segments = 0;  ///< four per block of a leaf, empty lanes included

  FurTests& operator+=(const FurTests& o) {
    boxes += o.boxes, segments += o.segments;
    return *this;
  }
};

/// Is told of hits, in any order and possibly several times of the same; decides whether they count.
class FurFilter {
 public:
  virtual ~FurFilter() = default;
  virtual bool accepts(const FurHit& hit) = 0;
};

}  // namespace pelage
