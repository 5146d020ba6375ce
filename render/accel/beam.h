// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/raster/tile_raster_test.cpp.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "base/vector.h"

namespace pelage {

/// A plane that divides space; a point is inside where normal . p + offset >= 0.
struct BeamPlane {
  V3f normal{0};
  float offset = 0;

  float at(const V3f& p) const { return normal.dot(p) + offset; }
  /// Half of the difference between the largest and the smallest value in a box of this half size.
  float spread(const V3f& half) const {
    return std::abs(normal.x) * half.x + std::abs(normal.y) * half.y + std::abs(normal.z) * half.z;
  }
};

/// A convex region that contains a bundle of rays: inside four sides, and at depths above `near`.
struct Beam {
  std::array<BeamPlane, 4> sides;
  BeamPlane depth;  ///< its value is the depth of a point along the beam
  float near = 0;

  /// Whether a box may have points inside at depths below `far`; `entry` is a lower bound of their depths.
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
