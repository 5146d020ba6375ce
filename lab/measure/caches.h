// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "world/scene_schema.h"

namespace pelage {

/// Replaces the cache folders of a scene's grooms by folders of the experiment. The experiment thus controls
/// which caches are cold and which are warm. The scene's caches stay unchanged.
class CacheFolders {
 public:
  CacheFolders(const SceneDescription& scene, const std::filesystem::path& folder);

  /// Whether any groom has a cache.
  bool any() const { return !grooms_.empty(); }
  /// --set arguments that redirect every cache to the folder of this name.
  std::vector<std::string> arguments(const std::string& name) const;
  /// Deletes the contents of the folder of this name.
  void clear(const std::string& name) const;
  std::filesystem::path folder(const std::string& name) const { return folder_ / name; }

 private:
  std::vector<std::string> grooms_;
  std::filesystem::path folder_;  // absolute
};

/// A YAML string.
std::string yaml_quoted(const std::string& text);

/// Total size of all files below a folder whose names start with `prefix`; 0 when there are none.
double folder_bytes(const std::filesystem::path& folder, const std::string& prefix = "");

}  // namespace pelage
