// SPDX-License-Identifier: Apache-2.0
// Tested in tests/world/scene_schema_test.cpp.
#include "world/asset_files.h"

#include <variant>

namespace pelage {

std::vector<std::filesystem::path> asset_files(const SceneDescription& scene) {
  std::vector<std::filesystem::path> files;
  const auto add = [&](const AssetPath& file) {
    if (!file.empty()) files.push_back(file.path);
  };
  for (const auto& skin : scene.skins.items) add(skin.value.mesh);
  for (const auto& groom : scene.grooms.items) {
    add(groom.value.strands_file);
    if (groom.value.density) ValueReader<Field>::add_files(*groom.value.density, files);
    for (const OperatorList::Item& item : groom.value.operators.items) {
      for (const ParameterText& parameter : item.prototype->parameters())
        files.insert(files.end(), parameter.files.begin(), parameter.files.end());
    }
  }
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
        },
        light.value);
  }
  return files;
}

}  // namespace pelage
