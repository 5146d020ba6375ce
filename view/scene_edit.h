// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <vector>

#include "base/file_stamp.h"
#include "world/scene_schema.h"

namespace pelage {

using FileStamps = std::map<std::filesystem::path, FileStamp>;

/// Returns the stamps of files as they are now.
FileStamps stamps_of(const std::vector<std::filesystem::path>& files);

/// Returns all files on which the picture of a scene depends: the scene file, its included files, and all
/// assets, including poses and the strand files that move guides in its first frame.
std::vector<std::filesystem::path> followed_files(const SceneDescription& scene);

/// A scene as it was read after an edit.
struct SceneEdit {
  SceneDescription scene;
  FileStamps files;  ///< of followed_files()
  std::chrono::steady_clock::time_point noticed = std::chrono::steady_clock::now();

  /// Returns what must be done again if everything was done for `before`.
  Redo redo_after(const SceneEdit& before) const;
};

}  // namespace pelage
