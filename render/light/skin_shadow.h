// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vector.h"
#include "geom/skin_balls.h"

namespace pelage {

/// A ball inside a closed, opaque skin, which proves that rays are blocked.
struct SkinShadow {
  SkinBall ball;               ///< radius 0: proves nothing
  const Box3f* box = nullptr;  ///< contains the skin over the whole shutter

  /// Returns whether the skin blocks a ray for certain: the ray meets the ball, and ends outside the box, so
  /// that it crosses the skin on the way. The origin may be anywhere, also inside the skin. `direction`:
  /// unit.
  bool blocks(const V3f& origin, const V3f& direction, float far) const {
    const V3f to = ball.center - origin;
    const float nearest = std::clamp(to.dot(direction), 0.0f, far);
    if (!((to - nearest * direction).length2() < ball.radius * ball.radius)) return false;
    return std::isinf(far) || !box->intersects(origin + far * direction);
  }
};

}  // namespace pelage
