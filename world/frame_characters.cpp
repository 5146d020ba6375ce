// SPDX-License-Identifier: Apache-2.0
#include "world/frame_characters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Imath/ImathBoxAlgo.h>

#include "procedurals/fur.h"
#include "render/scene/render_scene.h"

namespace pelage {
namespace {

bool is_prototype(const SceneDescription& scene, const std::string& character) {
  for (const auto& crowd : scene.crowds.items) {
    for (const NameReference& of : crowd.value.of) {
      if (of.name == character) return true;
    }
  }
  return false;
}

M44f to_world(const FrameCharacter& character, double time, const V3f& origin) {
  if (!character.member) return character_matrix(character.params->transform, time, origin);
  CrowdMember member = *character.member;
  member.position -= origin;
  return scale_of(member) * character_matrix(character.params->transform, time) * placement_of(member);
}

/// Motion of one part of a character.
struct Motion {
  const FrameCharacter& character;
  const std::vector<V3f>& rest;
  const PoseSequence* poses;  // null: at rest
  V3f origin;

  bool moves() const { return poses || pelage::moves(character.params->transform); }
  /// Frame of the poses at a frame of the scene.
  double shown_at(double time) const {
    return time + character.params->frame_offset + (character.member ? character.member->frame_offset : 0);
  }
  FrameMotion to_next(double frame) const {
    FrameMotion motion{{to_world(character, frame, origin), to_world(character, frame + 1, origin)}, {}};
    if (poses) motion.poses = {poses->at(shown_at(frame)), poses->at(shown_at(frame + 1))};
    return motion;
  }
  std::vector<V3f> cage(double time, const M44f& matrix) const {
    std::vector<V3f> cage = poses ? poses->positions(shown_at(time)) : rest;
    for (V3f& point : cage) point *= matrix;
    return cage;
  }
  void add_pose(double time, PosedCages& cages) const {
    const M44f matrix = to_world(character, time, origin);
    cages.cages.push_back(cage(time, matrix));
    cages.transforms.push_back(matrix);
  }
};

Motion motion_of(const FrameCharacter& character, size_t part, const Assets& assets,
                 const V3f& origin = V3f(0)) {
  const Assets::Skin& skin = assets.skins.at(character.params->parts[part].skin.name);
  const auto own = assets.part_poses.find({character.prototype, part});
  if (own != assets.part_poses.end()) return {character, skin.cage.positions, &own->second, origin};
  return {character, skin.cage.positions, skin.poses ? &*skin.poses : nullptr, origin};
}

}  // namespace

M44f character_matrix(const TransformParams& transform, double frame, const V3f& origin) {
  const float to_radians = std::numbers::pi_v<float> / 180;
  M44f scale, rotation, translation;
  scale.setScale(transform.scale.at(frame));
  rotation.setEulerAngles(transform.rotate.at(frame) * to_radians);
  translation.setTranslation(relative_to(transform.translate, origin).at(frame));
  return scale * rotation * translation;
}

bool moves(const TransformParams& transform) {
  return !transform.translate.is_constant() || !transform.rotate.is_constant() ||
         !transform.scale.is_constant();
}

std::vector<FrameCharacter> frame_characters(const SceneDescription& scene, const Assets& assets) {
  std::vector<FrameCharacter> found;
  for (const auto& [name, position, params] : scene.characters.items) {
    if (params.drawn.value_or(!is_prototype(scene, name))) found.push_back({name, name, &params, {}});
  }
  for (size_t crowd = 0; crowd < scene.crowds.items.size(); ++crowd) {
    const auto& [name, position, params] = scene.crowds.items[crowd];
    const std::vector<CrowdMember>& members = assets.crowds[crowd];
    for (size_t i = 0; i < members.size(); ++i) {
      const std::string& prototype = params.of[members[i].prototype].name;
      found.push_back(
          {name + "." + std::to_string(i), prototype, &scene.characters.find(prototype)->value, members[i]});
    }
  }
  return found;
}

int64_t frame_character_bytes(const SceneDescription& scene, const Assets& assets, const std::string& name,
                              const CharacterParams& character) {
  constexpr size_t kHeap = 16;  // per block: overhead and rounding of the heap
  constexpr size_t kName = 48;  // per name that is too long for a string's internal buffer
  const CrowdMember anyone;
  const FrameCharacter animal{name, name, &character, anyone};
  size_t bytes = sizeof(CrowdMember) + sizeof(FrameCharacter) + 2 * kName;
  for (size_t part = 0; part < character.parts.size(); ++part) {
    const Motion motion = motion_of(animal, part, assets);
    const bool shutter = scene.camera.shutter.y > scene.camera.shutter.x;
    const size_t times =
        motion.moves() && shutter ? static_cast<size_t>(scene.camera.motion_keys) + 2 : size_t(1);
    bytes += times * (motion.rest.size() * sizeof(V3f) + sizeof(std::vector<V3f>) + sizeof(M44f) + kHeap);
    bytes += sizeof(PosedCharacterSkin) + 4 * kHeap + sizeof(SkinPart) + kName;
    bytes += character.parts[part].grooms.items.size() *
             (sizeof(FurPart) + sizeof(FurProcedural) + sizeof(void*) + 2 * kName + 3 * kHeap);
  }
  return static_cast<int64_t>(bytes);
}

bool has_dynamics(const FrameCharacter& character, size_t part, const Assets& assets) {
  const auto& grooms = character.params->parts[part].grooms.items;
  return std::any_of(grooms.begin(), grooms.end(),
                     [&](const auto& groom) { return assets.grooms.at(groom.name)->guides() != nullptr; });
}

bool has_coat(const FrameCharacter& character) {
  return std::any_of(character.params->parts.begin(), character.params->parts.end(),
                     [](const PartParams& part) { return !part.grooms.items.empty(); });
}

Box3f approximate_box(const FrameCharacter& character, size_t part, const Assets& assets, double frame) {
  const Motion motion = motion_of(character, part, assets);
  if (character.member || !motion.poses) {
    const LimitSurface& rest = *assets.skins.at(character.params->parts[part].skin.name).rest;
    return Imath::transform(rest.control_bounds(), to_world(character, frame, V3f(0)));
  }
  PosedCages posed;
  motion.add_pose(frame, posed);
  Box3f box;
  for (const V3f& point : posed.cages.front()) box.extendBy(point);
  return box;
}

std::vector<V3f> posed_cage(const FrameCharacter& character, size_t part, const Assets& assets, double time) {
  return motion_of(character, part, assets).cage(time, to_world(character, time, V3f(0)));
}

CharacterPose pose_character(const FrameCharacter& character, size_t part, const Assets& assets,
                             const CameraParams& camera, double frame, const V3f& origin) {
  CharacterPose pose;
  pose.topology = assets.skins.at(character.params->parts[part].skin.name).rest->shared_topology();
  pose.scale = character.params->transform.scale.at(frame);
  if (character.member) {
    const V3f& axes = character.member->scale;
    pose.scale *= axes.x == axes.y && axes.y == axes.z ? axes.x : std::cbrt(axes.x * axes.y * axes.z);
    pose.length = character.member->length;
  }
  const Motion motion = motion_of(character, part, assets, origin);
  const double open = frame + camera.shutter.x, length = double(camera.shutter.y) - camera.shutter.x;
  const bool moves = motion.moves() || has_dynamics(character, part, assets);
  if (!moves) {
    motion.add_pose(frame, pose.shutter);
  } else if (!(length > 0)) {
    motion.add_pose(open, pose.shutter);
  } else {
    for (int key = 0; key < camera.motion_keys; ++key)
      motion.add_pose(open + length * key / (camera.motion_keys - 1), pose.shutter);
    for (double end : {frame - 0.5, frame + 0.5}) motion.add_pose(end, pose.frame_ends);
  }
  if (motion.moves()) pose.motion = motion.to_next(frame);
  return pose;
}

}  // namespace pelage
