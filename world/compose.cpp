// SPDX-License-Identifier: Apache-2.0
// Turns the scene description into the world of one frame.
#include "world/compose.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "base/program_identity.h"
#include "base/version.h"
#include "procedurals/detail/detail_policy.h"
#include "procedurals/fur.h"
#include "render/light/plate_light.h"
#include "render/light/spot_light.h"
#include "world/archives.h"
#include "world/camera_frame.h"
#include "world/coat_motion.h"
#include "world/frame_characters.h"
#include "world/light_links.h"
#include "world/scene_origin.h"

namespace pelage {

namespace {

size_t material_index(const SceneDescription& scene, const NameReference& material) {
  size_t index = 0;
  while (scene.materials.items[index].name != material.name) ++index;  // load_scene checked that it exists
  return index;
}

/// Poses a frame's characters one after the other.
class Composer {
 public:
  Composer(const SceneDescription& scene, const Assets& assets, double frame, const Job& job, World& world)
      : scene_(scene),
        assets_(assets),
        frame_(frame),
        job_(job),
        world_(world),
        lod_view_(lod_camera().lod_view()),
        detail_(scene.render.lod, lod_view_, scene.camera.shutter, job),
        poses_(std::make_shared<PoseCache>(job.workers.thread_count(), job.ledger)) {}

  void add_all(const std::vector<FrameCharacter>& characters) {
    for (const FrameCharacter& character : characters) {
      job_.check_stop();
      add(character, scene_.render.lod.enabled);
    }
    world_.poses = pose_hasher_.digest();
  }

 private:
  Camera lod_camera() const {
    const std::optional<CameraParams>& own = scene_.render.lod.camera.own;
    return own ? Camera(*own, frame_, scene_.image.width, scene_.image.height, world_.scene.origin)
               : world_.scene.camera;
  }

  void add(const FrameCharacter& character, bool reduced) {
    Box3f box;
    for (size_t part = 0; part < character.params->parts.size(); ++part)
      add_part(character, part, reduced, box);
    if (!has_coat(character)) return;
    ++world_.counts.characters;
    if (world_.scene.camera.may_see(box)) ++world_.counts.characters_in_frame;
  }

  void add_part(const FrameCharacter& character, size_t index, bool reduced, Box3f& box) {
    const PartParams& part = character.params->parts[index];
    const Assets::Skin& skin = assets_.skins.at(part.skin.name);
    CharacterPose pose =
        pose_character(character, index, assets_, scene_.camera, frame_, world_.scene.origin);
    for (const auto& groom : part.grooms.items) {
      if (assets_.grooms.at(groom.name)->needs_closest_point())
        pose.push_out_view = world_.scene.camera.view();
    }
    const Rgb tint = character.member ? character.member->tint : Rgb(1);
    const auto posed = std::make_shared<PosedCharacterSkin>(std::move(pose), poses_);
    charge(posed->bytes());
    pose_hasher_.add(posed->hash());
    box.extendBy(posed->bound(BoundSpan::kShutter));
    const size_t own = world_.scene.skins.size();
    world_.scene.skins.push_back({character.name + "." + part.skin.name,
                                  posed,
                                  skin.rest,
                                  material_index(scene_, part.material),
                                  tint,
                                  {},
                                  character.prototype + "." + part.skin.name});
    for (const auto& groom : part.grooms.items) {
      const auto& coat = assets_.grooms.at(groom.name);
      const auto shown = moved_coat(scene_, assets_, character, index, groom.name, frame_,
                                    static_cast<size_t>(posed->motion_keys()), job_);
      FurPart fur{
          character.name + "." + groom.name, {}, material_index(scene_, groom.value), skin.rest, tint};
      fur.scale = posed->scale();
      fur.skin = static_cast<uint32_t>(own);
      fur.follows = posed;
      fur.prototype = character.prototype + "." + groom.name;
      if (reduced) {
        fur.lod = detail_.simplification(*coat, skin.rest.get(), *posed);
        std::optional<Simplification>& densest = world_.scene.skins[own].lod;
        if (!densest || fur.lod->depth() > densest->depth()) densest = fur.lod;
      }
      fur.procedurals.push_back(std::make_unique<FurProcedural>(
          shown, posed, fur.lod, reduced ? detail_.direction(*coat, skin.rest) : nullptr));
      box.extendBy(fur.procedurals.back()->bound(BoundSpan::kShutter));
      world_.scene.fur.push_back(std::move(fur));
      count(*coat, *posed);
    }
  }

  void count(const Groom& groom, const PosedCharacterSkin& skin) {
    const auto strands = static_cast<int64_t>(groom.follicles().size());
    world_.counts.strands_described += strands;
    if (seen_.emplace(&groom, skin.hash().low, skin.hash().high, skin.length()).second)
      world_.counts.strands_unique += strands;
  }

  void charge(size_t bytes) {
    world_.charges.emplace_back(job_.ledger, MemoryTag::kSkins, static_cast<int64_t>(bytes));
  }

  const SceneDescription& scene_;
  const Assets& assets_;
  const double frame_;
  const Job& job_;
  World& world_;
  const LodView lod_view_;
  DetailPolicy detail_;
  std::shared_ptr<PoseCache> poses_;
  ContentHasher pose_hasher_;
  std::set<std::tuple<const Groom*, uint64_t, uint64_t, float>> seen_;  // coats on poses
};

FrameHeader header_of(const SceneDescription& scene, double frame) {
  FrameHeader header;
  header.frame = frame;
  header.shutter = scene.camera.shutter;
  header.frames_per_second = scene.units.fps;
  header.meters_per_unit = scene.units.meters_per_unit;
  header.seed = scene.render.seed;
  if (scene.render.adaptive) header.adaptive = "two-stage";
  header.dual = scene.render.indirect == IndirectLight::kDual;
  header.program_version = version();
  header.instruction_set = instruction_set();
  header.scene_hash = scene.hash;
  return header;
}

/// Makes something that the scene names at a position. Errors without a position get this one.
template <class Make>
auto made_at(const SourcePosition& position, const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) {
      if (problem.position.file.empty()) problem.position = position;
    }
    throw Error(error.kind(), std::move(problems));
  }
}

MagnetSet make_magnets(const SceneDescription& scene, double frame, const V3f& origin) {
  std::vector<MagnetSet::Magnet> magnets;
  for (const auto& item : scene.magnets.items)
    magnets.push_back(
        made_at(item.position, [&] { return make_magnet(item.name, item.value, frame, origin); }));
  return MagnetSet(std::move(magnets));
}

LightSet make_lights(const SceneDescription& scene, Assets& assets, double frame, const Job& job,
                     const V3f& origin, const Camera& camera) {
  std::vector<std::unique_ptr<Light>> lights;
  const float exposure = std::exp2(scene.camera.exposure.at(frame));
  for (const auto& [name, position, params] : scene.lights.items) {
    LightParams exposed = params;
    if (auto* sky = std::get_if<EnvironmentLightParams>(&exposed); sky && !scene.image.background.empty())
      sky->visible = false;
    if (exposure != 1) std::visit([&](auto& light) { light.radiance *= exposure; }, exposed);
    lights.push_back(made_at(position, [&, &of = name] {
      return make_light(of, exposed, frame, assets.textures, job.ledger, origin);
    }));
    const auto* spot = dynamic_cast<const SpotLight*>(lights.back().get());
    if (spot && spot->is_dark())
      job.progress.warn(to_string(std::get<SpotLightParams>(params).profile.position) +
                        ": the profile has no light within the cone of the spot");
  }
  if (const AssetPath& plate = scene.image.background; !plate.empty()) {
    lights.push_back(
        std::make_unique<PlateLight>(kBackground, assets.textures.load(plate), camera, scene.image.width));
  }
  return LightSet(std::move(lights));
}

void link_lights(const SceneDescription& scene, RenderScene& frame) {
  for (size_t i = 0; i < scene.lights.items.size(); ++i)
    link_light(scene.lights.items[i].value, frame.fur, frame.skins, frame.lights.light(i));
}

}  // namespace

World compose(const SceneDescription& scene, Assets& assets, double frame, const Job& job,
              CoordinateOrigin from) {
  const std::vector<FrameCharacter> characters = frame_characters(scene, assets);
  const CameraParams camera = focused_camera(placed_camera(scene, assets, job), assets, characters, frame);
  const V3f origin = from == CoordinateOrigin::kNearCoats
                         ? scene_origin(scene, assets, characters, camera.position.at(frame), frame, job)
                         : V3f(0);
  const Camera view(camera, frame, scene.image.width, scene.image.height, origin);
  World world{{{},
               {},
               assets.materials,
               make_lights(scene, assets, frame, job, origin, view),
               view,
               scene.image,
               scene.render,
               origin,
               make_magnets(scene, frame, origin)},
              0,
              0,
              0,
              0,
              header_of(scene, frame),
              {},
              camera};
  Composer(scene, assets, frame, job, world).add_all(characters);
  for (const auto& archive : scene.archives.items) {
    load_archive(scene, archive.name, archive.value, frame, job, origin, assets.archives[archive.name]);
    add_archive(scene, archive.name, archive.value, assets.archives.at(archive.name), job, world);
  }
  link_lights(scene, world.scene);
  return world;
}

void recompose_sampling(const SceneDescription& scene, Assets& assets, double frame, const Job& job,
                        World& world) {
  LightSet lights = make_lights(scene, assets, frame, job, world.scene.origin, world.scene.camera);
  std::vector<MaterialParams> materials = load_materials(scene, assets, job);
  world.header = header_of(scene, frame);
  assets.materials = std::move(materials);
  world.scene.materials = assets.materials;
  world.scene.lights = std::move(lights);
  world.scene.magnets = make_magnets(scene, frame, world.scene.origin);
  link_lights(scene, world.scene);
  world.scene.image = scene.image;
  world.scene.render = scene.render;
}

}  // namespace pelage
