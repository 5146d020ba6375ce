// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "world/scene_schema.h"

namespace pelage {

/// Returns the paths of all files that a scene names, except for poses: meshes, strands, guides, maps and
/// environments, with the files that those of USD name. Commands use the list to reject output files that
/// would overwrite these files.
std::vector<std::filesystem::path> asset_files(const SceneDescription& scene);

/// Appends the files that a groom names: of strands, maps and guides.
void add_groom_files(const GroomParams& groom, std::vector<std::filesystem::path>& files);

/// Returns the files of a sequence of poses, in order.
std::vector<std::filesystem::path> pose_files(const PosesParams& poses);

}  // namespace pelage
