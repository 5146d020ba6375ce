// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>

#include "render/light/light_set.h"

namespace pelage {

/// Calls `found(light, radiance)` for each visible light that a camera ray hits at `distance` or nearer.
/// `light`: index in `lights`. `time`: shutter time.
template <class Found>
void seen_lights(const LightSet& lights, const V3f& origin, const V3f& direction, float time, float distance,
                 const Found& found) {
  if (!lights.any_visible()) return;
  lights.on_ray(origin, direction, distance, [&](size_t i) {
    if (!lights.light(i).visible()) return;
    const auto hit = lights.light(i).seen(origin, direction, time);
    if (hit && !(hit->distance > distance)) found(i, hit->radiance);
  });
}

/// As seen_lights(), for the lights behind everything.
template <class Found>
void background_lights(const LightSet& lights, const V3f& origin, const V3f& direction, float time,
                       const Found& found) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  seen_lights(lights, origin, direction, time, kFar, [&](size_t i, const Rgb& radiance) {
    if (lights.light(i).is_infinitely_far()) found(i, radiance);
  });
}

}  // namespace pelage
