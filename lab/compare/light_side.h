// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "world/scene_schema.h"

namespace pelage {

/// A light as a photographer names it, by where it stands from the camera's place about what it looks at.
struct LightSide {
  const char* name;
  float turn;  ///< degrees about the camera's upright, 0 at the camera, positive to its left
  float rise;  ///< degrees above its line of sight
};
inline constexpr std::array<LightSide, 3> kLightSides = {
    {{"front", 25, 30}, {"side", 80, 30}, {"back", 155, 40}}};

/// The lights of a scene replaced by one lamp from that side and a faint even fill. The lamp stands as far
/// from what the camera looks at as the camera does, looks 16 degrees wide from there, and gives a white wall
/// facing it a radiance of 1.8.
Named<LightParams> lights_from(const LightSide& side, const CameraParams& camera, double frame);

/// White from everywhere, so that what absorbs nothing vanishes in it.
Named<LightParams> white_furnace();

}  // namespace pelage
