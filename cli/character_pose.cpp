// SPDX-License-Identifier: Apache-2.0
#include "cli/character_pose.h"

#include "cli/character_transform.h"

namespace pelage {

namespace {

void add_pose(const Assets::Skin& skin, const CharacterParams& character, double time, PosedCages& cages) {
  const M44f to_world = character_matrix(character.transform, time);
  std::vector<V3f> cage = skin.poses ? skin.poses->positions(time + character.frame_offset) : skin.cage;
  for (V3f& point : cage) point *= to_world;
  cages.cages.push_back(std::move(cage));
  cages.transforms.push_back(to_world);
}

}  // namespace

CharacterPose pose_character(const Assets::Skin& skin, const CharacterParams& character,
                             const CameraParams& camera, double frame) {
  CharacterPose pose;
  pose.topology = skin.rest->shared_topology();
  pose.scale = character.transform.scale.at(frame);
  const double open = frame + camera.shutter.x, length = double(camera.shutter.y) - camera.shutter.x;
  if (!(skin.poses || moves(character.transform))) {
    add_pose(skin, character, frame, pose.shutter);
  } else if (!(length > 0)) {
    add_pose(skin, character, open, pose.shutter);
  } else {
    for (int key = 0; key < camera.motion_keys; ++key)
      add_pose(skin, character, open + length * key / (camera.motion_keys - 1), pose.shutter);
    for (double end : {frame - 0.5, frame + 0.5}) add_pose(skin, character, end, pose.frame_ends);
  }
  return pose;
}

}  // namespace pelage
