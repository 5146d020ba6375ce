// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

/// Throws Error (kInput) with every map that grooms, and materials of characters' parts, look up where there
/// are no texture coordinates: on a mesh without them, or along strands on no skin. Each at its place in the
/// scene.
void check_maps(const SceneDescription& scene, const std::map<std::string, Assets::Skin>& skins);

}  // namespace pelage
