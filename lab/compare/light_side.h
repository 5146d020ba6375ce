// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "world/scene_schema.h"

namespace pelage {

/// A light named as photographers do, by its position relative to the camera and its target.
struct LightSide {
  const char* name;
  float turn;  ///< degrees about the camera's up axis, 0 at the camera, positive to its left
  float rise;  ///< degrees above the line of sight
};
inline constexpr std::array<LightSide, 3> kLightSides = {
    {{"front", 25, 30}, {"side", 80, 30}, {"back", 155, 40}}};

/// Replaces the lights of a scene by one lamp from that side and a weak uniform fill. The lamp is at the
/// camera's distance from the target, subtends 16 degrees from there, and lights a white wall facing it to a
/// radiance of 1.8.
Named<LightParams> lights_from(const LightSide& side, const CameraParams& camera, double frame);

/// Uniform white light, in which objects without absorption are invisible.
Named<LightParams> white_furnace();

}  // namespace pelage
