// SPDX-License-Identifier: Apache-2.0
#include "view/scene_edit.h"

#include <algorithm>
#include <set>
#include <span>

#include "world/asset_files.h"
#include "world/motion_files.h"

namespace pelage {
namespace {

/// The strand files that move guides in the frame that is shown.
std::vector<std::filesystem::path> shown_motion(const SceneDescription& scene) {
  return motion_files(scene, std::span(scene.frames.frames).first(1));
}

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
  const std::vector<std::filesystem::path> motion = shown_motion(scene);
  files.insert(motion.begin(), motion.end());
  return {files.begin(), files.end()};
}

Redo SceneEdit::redo_after(const SceneEdit& before) const {
  const auto has_changed = [&](const std::filesystem::path& file) {
    const auto now = files.find(file), known = before.files.find(file);
    // A file that only one of the scenes names is a change of the document.
    return now != files.end() && known != before.files.end() && now->second != known->second;
  };
  const std::vector<std::filesystem::path> assets = followed_assets(scene), motion = shown_motion(scene);
  if (std::any_of(assets.begin(), assets.end(), has_changed)) return Redo::kAssets;
  const Redo redo = compare_scenes(before.scene.parts, scene.parts);
  return std::any_of(motion.begin(), motion.end(), has_changed) ? std::max(redo, Redo::kGeometry) : redo;
}

}  // namespace pelage
