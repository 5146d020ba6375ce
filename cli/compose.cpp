// SPDX-License-Identifier: Apache-2.0
// The one page where everything meets: what the scene describes becomes the world of one frame.
#include "cli/compose.h"

#include <cmath>

#include "cli/character_transform.h"
#include "procedurals/fur.h"

namespace pelage {

namespace {

/// A moment of the frame, in frames; several when something moves while the shutter is open.
std::vector<double> motion_times(const CameraParams& camera, double frame, bool moves) {
  const float length = camera.shutter.y - camera.shutter.x;
  if (!moves) return {frame};
  if (!(length > 0)) return {frame + camera.shutter.x};
  std::vector<double> times;
  for (int key = 0; key < camera.motion_keys; ++key) {
    times.push_back(frame + camera.shutter.x + double(length) * key / (camera.motion_keys - 1));
  }
  return times;
}

LimitSurface posed_surface(const Assets::Skin& skin, const CharacterParams& character, double time) {
  std::vector<V3f> cage = skin.poses ? skin.poses->positions(time + character.frame_offset) : skin.cage;
  const M44f to_world = character_matrix(character.transform, time);
  for (V3f& point : cage) point *= to_world;
  return LimitSurface(skin.rest->shared_topology(), cage);
}

std::shared_ptr<const PosedCharacterSkin> pose_skin(const Assets::Skin& skin,
                                                    const CharacterParams& character,
                                                    const CameraParams& camera, const View& view,
                                                    double frame, bool needs_trees, const Workers& workers) {
  auto posed = std::make_shared<PosedCharacterSkin>();
  for (double time : motion_times(camera, frame, skin.poses || moves(character.transform))) {
    posed->keys.push_back(posed_surface(skin, character, time));
    posed->transforms.push_back(character_matrix(character.transform, time));
  }
  posed->mesh = std::make_shared<SkinMesh>(tessellate(posed->keys, view, {}, workers));
  for (size_t key = 0; needs_trees && key < posed->keys.size(); ++key) {
    posed->trees.emplace_back(*posed->mesh, static_cast<int>(key));
  }
  posed->scale = character.transform.scale.at(frame);
  return posed;
}

size_t material_index(const SceneDescription& scene, const NameReference& material) {
  size_t index = 0;
  while (scene.materials.items[index].name != material.name) ++index;  // load_scene checked that it exists
  return index;
}

void add_part(World& world, const SceneDescription& scene, const Assets& assets, const std::string& name,
              const CharacterParams& character, const PartParams& part, double frame, const Workers& workers,
              MemoryLedger& ledger) {
  const Assets::Skin& skin = assets.skins.at(part.skin.name);
  bool needs_trees = false;
  for (const auto& groom : part.grooms.items)
    needs_trees |= assets.grooms.at(groom.name)->needs_closest_point();
  const auto posed =
      pose_skin(skin, character, scene.camera, world.scene.camera.view(), frame, needs_trees, workers);
  world.charges.emplace_back(ledger, MemoryTag::kSkins, static_cast<int64_t>(posed->bytes()));
  world.scene.skins.push_back(
      {name + "." + part.skin.name, posed->mesh, skin.rest, material_index(scene, part.material)});

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
  for (const auto& [name, position, character] : scene.characters.items) {
    for (const PartParams& part : character.parts) {
      add_part(world, scene, assets, name, character, part, frame, workers, ledger);
    }
    ++world.characters;
  }
  return world;
}

}  // namespace pelage
