// SPDX-License-Identifier: Apache-2.0
#include "cli/drawn_characters.h"

#include <algorithm>
#include <cmath>

#include "cli/character_transform.h"

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

M44f to_world(const DrawnCharacter& character, double time) {
  const M44f own = character_matrix(character.params->transform, time);
  if (!character.member) return own;
  return scale_of(*character.member) * own * placement_of(*character.member);
}

void add_pose(const DrawnCharacter& character, const Assets::Skin& skin, double time, PosedCages& cages) {
  const M44f matrix = to_world(character, time);
  const double shown =
      time + character.params->frame_offset + (character.member ? character.member->frame_offset : 0);
  std::vector<V3f> cage = skin.poses ? skin.poses->positions(shown) : skin.cage.positions;
  for (V3f& point : cage) point *= matrix;
  cages.cages.push_back(std::move(cage));
  cages.transforms.push_back(matrix);
}

}  // namespace

std::vector<DrawnCharacter> drawn_characters(const SceneDescription& scene, const Assets& assets) {
  std::vector<DrawnCharacter> drawn;
  for (const auto& [name, position, params] : scene.characters.items) {
    if (params.drawn.value_or(!is_prototype(scene, name))) drawn.push_back({name, &params, {}});
  }
  for (size_t crowd = 0; crowd < scene.crowds.items.size(); ++crowd) {
    const auto& [name, position, params] = scene.crowds.items[crowd];
    const std::vector<CrowdMember>& members = assets.crowds[crowd];
    for (size_t i = 0; i < members.size(); ++i) {
      const std::string& prototype = params.of[members[i].prototype].name;
      drawn.push_back({name + "." + std::to_string(i), &scene.characters.find(prototype)->value, members[i]});
    }
  }
  return drawn;
}

CharacterPose pose_character(const DrawnCharacter& character, const Assets::Skin& skin,
                             std::shared_ptr<const SurfaceTopology> topology, const CameraParams& camera,
                             double frame) {
  CharacterPose pose;
  pose.topology = std::move(topology);
  pose.scale = character.params->transform.scale.at(frame);
  if (character.member) {
    const V3f& axes = character.member->scale;
    pose.scale *= axes.x == axes.y && axes.y == axes.z ? axes.x : std::cbrt(axes.x * axes.y * axes.z);
    pose.length = character.member->length;
  }
  const double open = frame + camera.shutter.x, length = double(camera.shutter.y) - camera.shutter.x;
  if (!(skin.poses || moves(character.params->transform))) {
    add_pose(character, skin, frame, pose.shutter);
  } else if (!(length > 0)) {
    add_pose(character, skin, open, pose.shutter);
  } else {
    for (int key = 0; key < camera.motion_keys; ++key)
      add_pose(character, skin, open + length * key / (camera.motion_keys - 1), pose.shutter);
    for (double end : {frame - 0.5, frame + 0.5}) add_pose(character, skin, end, pose.frame_ends);
  }
  return pose;
}

}  // namespace pelage
