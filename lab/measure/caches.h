// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "world/scene_schema.h"

namespace pelage {

/// Folders of an experiment's own in place of those that the grooms of a scene keep their caches in, so that
/// it decides what is cold and what is warm, and leaves the scene's caches alone.
class CacheFolders {
 public:
  CacheFolders(const SceneDescription& scene, const std::filesystem::path& folder);

  /// Whether any groom has a cache.
  bool any() const { return !grooms_.empty(); }
  /// --set arguments that send every cache to the folder of this name.
  std::vector<std::string> arguments(const std::string& name) const;
  /// Forgets what the folder of this name holds.
  void clear(const std::string& name) const;
  std::filesystem::path folder(const std::string& name) const { return folder_ / name; }

 private:
  std::vector<std::string> grooms_;
  std::filesystem::path folder_;  // absolute
};

/// A YAML string.
std::string yaml_quoted(const std::string& text);

/// Bytes of all files below a folder whose names begin so; 0 when there are none.
double folder_bytes(const std::filesystem::path& folder, const std::string& prefix = "");

}  // namespace pelage
