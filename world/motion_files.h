// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "world/scene_schema.h"

namespace pelage {

/// Returns the first and the last frame whose guides a picture of a frame needs, if they are known at whole
/// frames.
std::pair<int, int> whole_frames_around(const CameraParams& camera, double frame);

/// Returns the strand files of guides that pictures of these frames read, without duplicates. Files for
/// frames nearby need not exist.
std::vector<std::filesystem::path> motion_files(const SceneDescription& scene, std::span<const int> frames);

/// Returns a hash of the contents of these files for each groom that has such files, as FrameInputs.
std::map<std::string, std::string> motion_file_inputs(const SceneDescription& scene,
                                                      std::span<const int> frames);

}  // namespace pelage
