// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/vector.h"
#include "render/sampling/warp.h"

namespace pelage {

/// Three perpendicular unit vectors of something that faces a point: z towards the point, y as near as
/// possible to an up vector.
struct Aim {
  V3f x, y, z;

  /// Empty if `position` and `look_at` are the same point. `up` may have any length and direction.
  static std::optional<Aim> at(const V3f& position, const V3f& look_at, const V3f& up) {
    const V3f forward = look_at - position;
    if (!(forward.length() > 0)) return std::nullopt;
    Aim aim;
    aim.z = forward.normalized();
    aim.x = up.cross(aim.z);
    if (aim.x.length() > 1e-6f * up.length()) {
      aim.x.normalize();
    } else {
      V3f unused;
      complete_frame(aim.z, aim.x, unused);
    }
    aim.y = aim.z.cross(aim.x);
    return aim;
  }
};

}  // namespace pelage
