// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "base/progress.h"
#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

/// Throws Error (kInput) if a map, or a ramp along u or v, is used where there are no texture coordinates: on
/// a mesh without texture coordinates, or on strands without a skin. Checks all grooms, and the materials of
/// all characters. The error lists such maps and ramps with their positions in the scene: the first 20, and
/// the count of the others.
///
/// Warns where the texture coordinates of a skin leave the image of a map that does not repeat, such as those
/// of UDIM tiles.
void check_maps(const SceneDescription& scene, const std::map<std::string, Assets::Skin>& skins,
                Progress& progress);

}  // namespace pelage
