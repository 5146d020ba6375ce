// SPDX-License-Identifier: Apache-2.0
// The one page where everything meets: what the scene describes becomes the world of one frame.
#include "cli/compose.h"

#include "cli/character_pose.h"
#include "procedurals/fur.h"

namespace pelage {

namespace {

size_t material_index(const SceneDescription& scene, const NameReference& material) {
  size_t index = 0;
  while (scene.materials.items[index].name != material.name) ++index;  // load_scene checked that it exists
  return index;
}

void add_part(World& world, const SceneDescription& scene, const Assets& assets, const std::string& name,
              const CharacterParams& character, const PartParams& part, double frame,
              const std::shared_ptr<PoseCache>& poses, MemoryLedger& ledger) {
  const Assets::Skin& skin = assets.skins.at(part.skin.name);
  CharacterPose pose = pose_character(skin, character, scene.camera, frame);
  for (const auto& groom : part.grooms.items) {
    if (assets.grooms.at(groom.name)->needs_closest_point()) pose.push_out_view = world.scene.camera.view();
  }
  const auto posed = std::make_shared<PosedCharacterSkin>(std::move(pose), poses);
  world.charges.emplace_back(ledger, MemoryTag::kSkins, static_cast<int64_t>(posed->bytes()));
  world.scene.skins.push_back(
      {name + "." + part.skin.name, posed, skin.rest, material_index(scene, part.material)});

  for (const auto& groom : part.grooms.items) {
    FurPart fur{name + "." + groom.name, {}, material_index(scene, groom.value), skin.rest};
    fur.procedurals.push_back(std::make_unique<FurProcedural>(assets.grooms.at(groom.name), posed));
    world.strands_described += static_cast<int64_t>(assets.grooms.at(groom.name)->follicles().size());
    world.scene.fur.push_back(std::move(fur));
  }
}

}  // namespace

World compose(const SceneDescription& scene, Assets& assets, double frame, const Workers& workers,
              MemoryLedger& ledger) {
  std::vector<std::unique_ptr<Light>> lights;
  for (const auto& [name, position, params] : scene.lights.items) {
    lights.push_back(make_light(name, params, frame, assets.textures, ledger));
  }
  World world{{{},
               {},
               assets.materials,
               LightSet(std::move(lights)),
               Camera(scene.camera, frame, scene.image.width, scene.image.height),
               scene.image,
               scene.render},
              0,
              0,
              {}};
  const auto poses = std::make_shared<PoseCache>(workers.thread_count(), ledger);
  for (const auto& [name, position, character] : scene.characters.items) {
    for (const PartParams& part : character.parts) {
      add_part(world, scene, assets, name, character, part, frame, poses, ledger);
    }
    ++world.characters;
  }
  return world;
}

}  // namespace pelage
