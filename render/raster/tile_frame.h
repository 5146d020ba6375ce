// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "base/vector.h"

namespace pelage {

/// An orthonormal frame in world space. Its z axis is the view direction through the middle of a tile.
struct TileFrame {
  V3f origin{0};
  std::array<V3f, 3> axes{V3f(1, 0, 0), V3f(0, 1, 0), V3f(0, 0, 1)};

  /// Returns a frame with this origin and z axis. `direction`: unit.
  static TileFrame along(const V3f& origin, const V3f& direction) {
    const V3f side = direction.cross(std::abs(direction.x) < 0.6f ? V3f(1, 0, 0) : V3f(0, 1, 0)).normalized();
    return {origin, {side, direction.cross(side).normalized(), direction}};
  }
  /// Converts a vector from world space.
  V3f rotated(const V3f& v) const { return {axes[0].dot(v), axes[1].dot(v), axes[2].dot(v)}; }
  /// Converts a point from world space.
  V3f local(const V3f& world) const { return rotated(world - origin); }
};

}  // namespace pelage
