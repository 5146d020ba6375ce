// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/vector.h"
#include "geom/skin_balls.h"

namespace pelage {

/// The fur of a skin as a shell around each of its balls, of a uniform density. It stands for the strands
/// when rays are not traced [Neulander04].
struct CoatShell {
  float thickness = 0;  ///< scene units; 0: no shell
  float density = 0;    ///< extinction per unit of length

  /// Returns the length of the part of a ray that is inside the outer sphere.
  float way(const SkinBall& ball, const V3f& origin, const V3f& direction, float far) const {
    const V3f to = ball.center - origin;
    const float nearest = to.dot(direction), outer = ball.radius + thickness;
    const float half2 = outer * outer - (to - nearest * direction).length2();
    if (!(half2 > 0)) return 0;
    const float half = std::sqrt(half2);
    return std::max(0.0f, std::min(nearest + half, far) - std::max(nearest - half, 0.0f));
  }
  /// Returns the fraction of light that a ray transmits which the ball does not block.
  float transmittance(const SkinBall& ball, const V3f& origin, const V3f& direction, float far) const {
    return std::exp(-density * way(ball, origin, direction, far));
  }
};

/// A ball inside a closed, opaque skin, which proves that rays are blocked.
struct SkinShadow {
  SkinBall ball;               ///< radius 0: proves nothing
  const Box3f* box = nullptr;  ///< contains the skin over the whole shutter
  CoatShell shell = {};        ///< replaces tracing, if its thickness is not 0
  uint32_t skin = 0;           ///< index of the skin in its scene

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
