// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "world/scene_schema.h"

namespace pelage {

/// Returns the paths of all files that a scene names, except for poses: meshes, strands, guides, maps and
/// environments. Commands use the list to reject output files that would overwrite these files.
std::vector<std::filesystem::path> asset_files(const SceneDescription& scene);

}  // namespace pelage
