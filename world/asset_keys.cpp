// SPDX-License-Identifier: Apache-2.0
#include "world/asset_keys.h"

#include <vector>

#include "base/file_stamp.h"
#include "world/asset_files.h"

namespace pelage {
namespace {

void add_part(const SceneDescription& scene, const std::string& path, ContentHasher& hasher) {
  const auto part = scene.parts.find(path);
  hasher.add(path).add(part == scene.parts.end() ? ContentHash() : part->second);
}

void add_files(const std::vector<std::filesystem::path>& files, ContentHasher& hasher) {
  for (const std::filesystem::path& file : files) {
    const FileStamp stamp = file_stamp(file);
    hasher.add(file.string()).add(stamp.inode).add(stamp.size).add(stamp.changed_ns);
  }
}

}  // namespace

ContentHash skin_key(const SceneDescription& scene, const std::string& name, const SkinParams& params) {
  ContentHasher hasher;
  add_part(scene, "skins." + name, hasher);
  add_files({params.mesh.path}, hasher);
  if (params.poses) add_files(pose_files(*params.poses), hasher);
  return hasher.digest();
}

ContentHash groom_key(const SceneDescription& scene, const std::string& name, const GroomParams& params,
                      const ContentHash& skin) {
  ContentHasher hasher;
  add_part(scene, "grooms." + name, hasher);
  std::vector<std::filesystem::path> files;
  add_groom_files(params, files);
  add_files(files, hasher);
  return hasher.add(skin).add(params.leaf_size()).digest();  // its size may depend on the memory limit
}

}  // namespace pelage
