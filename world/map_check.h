// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

/// Throws Error (kInput) if maps of grooms, or of materials of characters' parts, are used without texture
/// coordinates: on a mesh that has none, or on strands without a skin. Lists every such map with its position
/// in the scene.
void check_maps(const SceneDescription& scene, const std::map<std::string, Assets::Skin>& skins);

}  // namespace pelage
