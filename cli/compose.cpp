// SPDX-License-Identifier: Apache-2.0
// The one page where everything meets: a checked scene becomes a world of skins, coats, materials, lights and a camera.
#include "cli/compose.h"

#include "base/check.h"
#include "cli/transform.h"
#include "geom/io/obj_file.h"
#include "procedurals/fur.h"

namespace pelage {

namespace {

Assets::Skin load_skin(const SkinParams& params, std::map<std::string, std::shared_ptr<const SurfaceTopology>>& shared) {
  const ControlMesh cage = read_obj(params.mesh.path);
  auto topology = SurfaceTopology::create(cage, params.scheme, params.boundary, params.mesh.path.string());
  // Characters of identical topology share one refiner and one set of patches.
  const ContentHash hash = topology->hash();
  topology = shared.emplace(std::to_string(hash.high) + ":" + std::to_string(hash.low), topology).first->second;

  Assets::Skin skin;
  skin.rest = std::make_shared<LimitSurface>(topology, cage.positions);
  skin.rest_positions = cage.positions;
  if (params.poses) skin.poses.emplace(params.poses->sequence(), cage.positions.size());
  return skin;
}

MaterialParams with_textures(MaterialParams material, TextureLibrary& textures) {
  std::visit([&](auto& params) { params.load_textures(textures); }, material);
  return material;
}

// Cage positions of a skin at a time in frames, in world space.
std::vector<V3f> posed_positions(const Assets::Skin& skin, const CharacterParams& character, double frame) {
  std::vector<V3f> positions =
      skin.poses ? skin.poses->positions(frame + character.frame_offset) : skin.rest_positions;
  const M44f to_world = character.transform.matrix(frame);
  for (V3f& p : positions) p = p * to_world;
  return positions;
}

std::shared_ptr<PosedCharacterSkin> pose_skin(const Assets::Skin& skin, const CharacterParams& character,
                                              const CameraParams& camera, const View& view, double frame,
                                              bool needs_inside, const Workers& workers) {
  auto posed = std::make_shared<PosedCharacterSkin>();
  const bool moves = (skin.poses || character.transform.moves()) && camera.shutter.x < camera.shutter.y;
  const int keys = moves ? camera.motion_keys : 1;
  for (int key = 0; key < keys; ++key) {
    const double t = keys > 1 ? double(key) / (keys - 1) : 0.0;
    const double offset = moves ? camera.shutter.x + t * (camera.shutter.y - camera.shutter.x) : 0.0;
    posed->keys.emplace_back(skin.rest->shared_topology(), posed_positions(skin, character, frame + offset));
  }
  posed->mesh = std::make_shared<SkinMesh>(tessellate(posed->keys, view, {}, workers));
  posed->scale = character.transform.uniform_scale(frame);
  for (int key = 0; needs_inside && key < keys; ++key) posed->trees.emplace_back(*posed->mesh, key);
  return posed;
}

}  // namespace

Assets load_assets(const SceneDescription& description, const Workers& workers, MemoryLedger& ledger) {
  Assets assets;
  assets.textures = std::make_unique<TextureLibrary>(ledger);
  std::map<std::string, std::shared_ptr<const SurfaceTopology>> topologies;
  for (const auto& [name, position, params] : description.skins.items) {
    assets.skins.emplace(name, load_skin(params, topologies));
  }
  for (const auto& [name, position, params] : description.grooms.items) {
    const auto skin = assets.skins.find(params.skin);
    assets.grooms[name] = Groom::create(name, params, skin == assets.skins.end() ? nullptr : skin->second.rest,
                                        *assets.textures, workers, ledger);
  }
  for (const auto& [name, position, params] : description.materials.items) {
    assets.materials.push_back(with_textures(params, *assets.textures));
  }
  return assets;
}

World compose(const SceneDescription& description, Assets& assets, double frame, const Workers& workers,
              MemoryLedger& ledger) {
  const Camera camera(description.camera, frame, description.image.width, description.image.height);
  std::vector<std::unique_ptr<Light>> lights;
  for (const auto& [name, position, params] : description.lights.items) {
    lights.push_back(make_light(name, params, frame, *assets.textures, ledger));
  }
  World world{{{}, {}, assets.materials, LightSet(std::move(lights)), camera, description.image, description.render}};

  for (const auto& [name, position, character] : description.characters.items) {
    for (const PartParams& part : character.parts) {
      const Assets::Skin& skin = assets.skins.at(part.skin);
      bool needs_inside = false;
      for (const auto& groom : part.grooms.items) needs_inside |= assets.grooms.at(groom.name)->needs_closest_point();
      const auto posed = pose_skin(skin, character, description.camera, camera.view(), frame, needs_inside, workers);
      world.scene.skins.push_back({name + "." + part.skin, posed->mesh, skin.rest, description.material_index(part.material)});
      for (const auto& groom : part.grooms.items) {
        const std::shared_ptr<const Groom>& coat = assets.grooms.at(groom.name);
        FurPart fur{name + "." + groom.name, {}, description.material_index(groom.value)};
        fur.procedurals.push_back(std::make_unique<FurProcedural>(coat, posed));
        world.scene.fur.push_back(std::move(fur));
        world.strands_described += static_cast<int64_t>(coat->strand_count());
      }
    }
    ++world.characters;
  }
  return world;
}

}  // namespace pelage
