// SPDX-License-Identifier: Apache-2.0
#include "world/asset_files.h"

#include <variant>

#include "geom/usd/usd_files.h"

namespace pelage {

void add_groom_files(const GroomParams& groom, std::vector<std::filesystem::path>& files) {
  ValueReader<AssetPath>::add_files(groom.strands_file, files);
  if (groom.density) ValueReader<Field>::add_files(*groom.density, files);
  for (const OperatorList::Item& item : groom.operators.items) {
    for (const ParameterText& parameter : item.prototype->parameters())
      files.insert(files.end(), parameter.files.begin(), parameter.files.end());
  }
}

std::vector<std::filesystem::path> pose_files(const PosesParams& poses) {
  std::vector<std::filesystem::path> files;
  if (poses.files.data) return files;
  for (int i = 0; i < poses.count; ++i)
    files.emplace_back(frame_file_name(poses.files.path.string(), poses.first + i));
  return files;
}

std::vector<std::filesystem::path> asset_files(const SceneDescription& scene) {
  std::vector<std::filesystem::path> files;
  const auto add = [&](const AssetPath& file) { ValueReader<AssetPath>::add_files(file, files); };
  for (const auto& skin : scene.skins.items) add(skin.value.mesh);
  add(scene.image.background);
  for (const auto& archive : scene.archives.items) add(archive.value.rib);
  for (const auto& groom : scene.grooms.items) add_groom_files(groom.value, files);
  for (const auto& material : scene.materials.items) {
    std::visit(
        [&](const auto& params) {
          ValueReader<Field>::add_files(params.color, files);
          if constexpr (requires { params.opacity; }) ValueReader<Field>::add_files(params.opacity, files);
        },
        material.value);
  }
  for (const auto& light : scene.lights.items) {
    std::visit(
        [&](const auto& params) {
          if constexpr (requires { params.file; }) add(params.file);
          if constexpr (requires { params.profile; }) add(params.profile);
        },
        light.value);
  }
  return with_usd_files(files);
}

}  // namespace pelage
