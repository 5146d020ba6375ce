// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "world/scene_schema.h"

namespace pelage {

/// A lamp position that photographers have a name for, relative to the camera and the camera's target.
struct LightSide {
  const char* name;
  float turn;  ///< degrees about the camera's up axis: 0 at the camera, positive to the left of the camera
  float rise;  ///< degrees of the lamp above the line of sight
};
inline constexpr std::array<LightSide, 3> kLightSides = {
    {{"front", 25, 30}, {"side", 80, 30}, {"back", 155, 40}}};

/// Returns lights that replace those of a scene: one lamp at this position and a weak uniform fill light. The
/// lamp is as far from the target as the camera, and its diameter subtends 16 degrees at the target. A white
/// wall at the target that faces the lamp has the radiance 1.8.
Named<LightParams> lights_from(const LightSide& side, const CameraParams& camera, double frame);

/// Returns a uniform white light. Objects without absorption are invisible in it.
Named<LightParams> white_furnace();

}  // namespace pelage
