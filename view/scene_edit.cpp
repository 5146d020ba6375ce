// SPDX-License-Identifier: Apache-2.0
#include "view/scene_edit.h"

#include <set>

#include "world/asset_files.h"

namespace pelage {
namespace {

/// The files that a scene names, including poses.
std::vector<std::filesystem::path> followed_assets(const SceneDescription& scene) {
  std::vector<std::filesystem::path> files = asset_files(scene);
  const auto add = [&](const PosesParams& poses) {
    const std::vector<std::filesystem::path> more = pose_files(poses);
    files.insert(files.end(), more.begin(), more.end());
  };
  for (const auto& skin : scene.skins.items) {
    if (skin.value.poses) add(*skin.value.poses);
  }
  for (const auto& character : scene.characters.items) {
    for (const PartParams& part : character.value.parts) {
      if (part.poses) add(*part.poses);
    }
  }
  return files;
}

}  // namespace

FileStamps stamps_of(const std::vector<std::filesystem::path>& files) {
  FileStamps stamps;
  for (const std::filesystem::path& file : files) stamps[file] = file_stamp(file);
  return stamps;
}

std::vector<std::filesystem::path> followed_files(const SceneDescription& scene) {
  const std::vector<std::filesystem::path> assets = followed_assets(scene);
  std::set<std::filesystem::path> files(scene.files.begin(), scene.files.end());
  files.insert(assets.begin(), assets.end());
  return {files.begin(), files.end()};
}

Redo SceneEdit::redo_after(const SceneEdit& before) const {
  for (const std::filesystem::path& file : followed_assets(scene)) {
    const auto now = files.find(file), known = before.files.find(file);
    // A file that only one of the scenes names is a change of the document.
    if (now != files.end() && known != before.files.end() && now->second != known->second)
      return Redo::kAssets;
  }
  return compare_scenes(before.scene.parts, scene.parts);
}

}  // namespace pelage
