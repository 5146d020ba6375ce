// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "world/scene_schema.h"

namespace pelage {

/// A light with a photographer's name for its position relative to the camera and the camera's target.
struct LightSide {
  const char* name;
  float turn;  ///< degrees about the camera's up axis, 0 at the camera, positive to its left
  float rise;  ///< degrees above the line of sight
};
inline constexpr std::array<LightSide, 3> kLightSides = {
    {{"front", 25, 30}, {"side", 80, 30}, {"back", 155, 40}}};

/// Replaces the lights of a scene by one lamp on this side and a weak uniform fill light. The lamp is as far
/// from the target as the camera and subtends 16 degrees at the target. A white wall at the target that faces
/// the lamp has the radiance 1.8.
Named<LightParams> lights_from(const LightSide& side, const CameraParams& camera, double frame);

/// Uniform white light, in which objects without absorption are invisible.
Named<LightParams> white_furnace();

}  // namespace pelage
