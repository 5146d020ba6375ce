// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "world/scene_schema.h"

namespace pelage {

/// The files that a scene names, apart from poses: meshes, strands, guides, maps and environments. A run that
/// wrote to one of them would destroy what somebody made.
std::vector<std::filesystem::path> asset_files(const SceneDescription& scene);

}  // namespace pelage
