// SPDX-License-Identifier: Apache-2.0
// Tested in tests/view/live_renderer_test.cpp.
#include "view/scene_edit.h"

#include <set>

#include <sys/stat.h>

namespace pelage {
namespace {

void add_poses(const PosesParams& poses, std::vector<std::filesystem::path>& files) {
  for (int i = 0; i < poses.count; ++i)
    files.emplace_back(frame_file_name(poses.files.path.string(), poses.first + i));
}

/// Files that contain values of the scene; all others are assets.
bool is_document(const std::filesystem::path& file) {
  return file.extension() == ".yaml" || file.extension() == ".yml";
}

}  // namespace

FileStamps stamps_of(const std::vector<std::filesystem::path>& files) {
  FileStamps stamps;
  for (const std::filesystem::path& file : files) {
    FileStamp& stamp = stamps[file];
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) continue;
    stamp = {status.st_ino, status.st_size,
             int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec};
  }
  return stamps;
}

std::vector<std::filesystem::path> followed_files(const SceneDescription& scene) {
  std::vector<std::filesystem::path> files = scene.files;
  for (const auto& skin : scene.skins.items) {
    if (skin.value.poses) add_poses(*skin.value.poses, files);
  }
  for (const auto& character : scene.characters.items) {
    for (const PartParams& part : character.value.parts) {
      if (part.poses) add_poses(*part.poses, files);
    }
  }
  const std::set<std::filesystem::path> unique(files.begin(), files.end());
  return {unique.begin(), unique.end()};
}

Redo SceneEdit::redo_after(const SceneEdit& before) const {
  FileStamps assets, assets_before;
  for (const auto& [file, stamp] : files) {
    if (!is_document(file)) assets[file] = stamp;
  }
  for (const auto& [file, stamp] : before.files) {
    if (!is_document(file)) assets_before[file] = stamp;
  }
  // A file that only one of the scenes names is a change of the document.
  for (const auto& [file, stamp] : assets) {
    const auto known = assets_before.find(file);
    if (known != assets_before.end() && known->second != stamp) return Redo::kAssets;
  }
  return compare_scenes(before.scene.parts, scene.parts);
}

}  // namespace pelage
