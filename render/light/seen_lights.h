// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>

#include "render/light/light_set.h"

namespace pelage {

/// Calls `found(light, radiance)` for each visible light that a camera ray hits at `distance` or nearer.
/// `light`: index in `lights`.
template <class Found>
void seen_lights(const LightSet& lights, const V3f& origin, const V3f& direction, float distance,
                 const Found& found) {
  for (size_t i = 0; i < lights.size(); ++i) {
    const Light& light = lights.light(i);
    if (!light.visible() || (light.is_infinitely_far() && std::isfinite(distance))) continue;
    const auto hit = light.intersect(origin, direction);
    if (hit && !(hit->distance > distance)) found(i, hit->radiance);
  }
}

}  // namespace pelage
