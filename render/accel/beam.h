// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "base/vector.h"

namespace pelage {

/// A plane. A point p is on the inside if normal . p + offset >= 0.
struct BeamPlane {
  V3f normal{0};
  float offset = 0;

  float at(const V3f& p) const { return normal.dot(p) + offset; }
  /// Returns half of the difference between the max and the min of at() in a box of this half size.
  float spread(const V3f& half) const {
    return std::abs(normal.x) * half.x + std::abs(normal.y) * half.y + std::abs(normal.z) * half.z;
  }
};

/// A convex region that contains a bundle of rays: the inside of four planes, at depths above `near`.
struct Beam {
  std::array<BeamPlane, 4> sides;
  BeamPlane across[2];  ///< at(p) is the position of p across the beam, by axis
  BeamPlane depth;      ///< at(p) is the depth of p along the beam
  float near = 0;

  /// Returns whether a box may have points in the beam at depths below `far`. Stores a lower bound of the
  /// depths of such points in `entry`.
  bool meets(const V3f& centre, const V3f& half, float far, float& entry) const {
    for (const BeamPlane& side : sides) {
      if (side.at(centre) + side.spread(half) < 0) return false;
    }
    const float middle = depth.at(centre), spread = depth.spread(half);
    entry = middle - spread;
    return middle + spread >= near && entry <= far;
  }
  bool meets(const Box3f& box, float far, float& entry) const {
    if (box.isEmpty()) return false;
    const V3f half = 0.5f * box.size();
    entry = -std::numeric_limits<float>::max();
    return !std::isfinite(half.x + half.y + half.z) || meets(box.center(), half, far, entry);
  }
};

}  // namespace pelage
