// SPDX-License-Identifier: Apache-2.0
#include "world/complete_scene.h"

#include "base/nearest_name.h"

namespace pelage {

void complete_parts(SceneDescription& scene, Problems& problems) {
  bool needed = false;
  for (auto& [name, position, character] : scene.characters.items) {
    for (PartParams& part : character.parts) {
      const std::string where = "a part of character " + quote(name);
      if (!part.skin.name.empty()) {
        if (part.material.name.empty())
          problems.add(part.skin.position, where + " needs the `material` of its skin");
        continue;
      }
      if (part.grooms.items.empty()) problems.add(position, where + " needs a skin, or grooms");
      if (part.poses) problems.add(part.poses->files.position, where + " has poses, but no skin");
      if (!part.material.name.empty())
        problems.add(part.material.position, where + " has the `material` of a skin, but no skin");
      for (const auto& groom : part.grooms.items) {
        const auto* grown = scene.grooms.find(groom.name);
        if (grown && grown->value.strands_file.empty())
          problems.add(groom.position,
                       "groom " + quote(groom.name) + " grows on a skin, which its part lacks");
      }
      part.skin.name = kNoSkin;
      part.material.name = kNoSkin;
      needed = true;
    }
  }
  if (!needed) return;
  scene.skins.items.push_back({kNoSkin, {}, SkinParams()});
  scene.skins.items.back().value.scheme = SubdivisionScheme::kNone;
  scene.materials.items.push_back({kNoSkin, {}, LambertParams()});
}

void set_scale(SceneDescription& scene) {
  const float meters = scene.units.meters_per_unit;
  scene.camera.meters_per_unit = meters;
  if (scene.render.lod.camera.own) scene.render.lod.camera.own->meters_per_unit = meters;
  for (auto& skin : scene.skins.items) skin.value.transform.meters_per_unit = meters;
  for (auto& light : scene.lights.items) {
    if (auto* mesh = std::get_if<MeshLightParams>(&light.value)) mesh->transform.meters_per_unit = meters;
  }
  for (auto& groom : scene.grooms.items) {
    if (groom.value.transform) groom.value.transform->meters_per_unit = meters;
  }
}

}  // namespace pelage
