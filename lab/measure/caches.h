// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "world/scene_schema.h"

namespace pelage {

/// Replaces the cache folders of a scene's grooms by folders of the experiment, so that the experiment
/// controls which caches are cold and which are warm. The scene's own caches stay unchanged.
class CacheFolders {
 public:
  CacheFolders(const SceneDescription& scene, const std::filesystem::path& folder);

  /// Whether any groom of the scene has a cache.
  bool any() const { return !grooms_.empty(); }
  /// Returns --set arguments that redirect the cache of every groom to the folder called `name`.
  std::vector<std::string> arguments(const std::string& name) const;
  /// Deletes the folder called `name` with its contents.
  void clear(const std::string& name) const;
  std::filesystem::path folder(const std::string& name) const { return folder_ / name; }

 private:
  std::vector<std::string> grooms_;
  std::filesystem::path folder_;  // absolute path
};

/// Returns `text` as a quoted YAML string.
std::string yaml_quoted(const std::string& text);

/// Returns the total size in bytes of all files below a folder whose names start with `prefix`; 0 when there
/// are none.
double folder_bytes(const std::filesystem::path& folder, const std::string& prefix = "");

}  // namespace pelage
