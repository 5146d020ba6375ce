// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "world/scene_schema.h"

namespace pelage {

/// The files that a scene names, except poses: meshes, strands, guides, maps and environments. Used to refuse
/// output files that would overwrite them.
std::vector<std::filesystem::path> asset_files(const SceneDescription& scene);

}  // namespace pelage
