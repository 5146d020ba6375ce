// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "procedurals/skin/posed_character_skin.h"
#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

/// A character that is visible in the picture: a single character of the scene, or an animal of a crowd.
struct FrameCharacter {
  std::string name;       ///< "rat", or "colony.17" for an animal of a crowd, counted from 0
  std::string prototype;  ///< name of the character of the scene that it is or is copied from
  const CharacterParams* params = nullptr;  ///< parameters of the prototype
  std::optional<CrowdMember> member;        ///< only for an animal of a crowd
};

/// Returns all visible characters of a scene: first the single characters, then the animals of each crowd, in
/// the order of the scene. `scene` must outlive the result.
std::vector<FrameCharacter> frame_characters(const SceneDescription& scene, const Assets& assets);

/// Returns the memory in bytes that one animal of a crowd takes in a frame: its names, posed cages and
/// descriptions of its coats. `name` and `character`: the animal's prototype. The result does not include
/// grown strands and whole poses (class PoseCache).
int64_t frame_character_bytes(const SceneDescription& scene, const Assets& assets, const std::string& name,
                              const CharacterParams& character);

/// Returns whether the character has any groom.
bool has_coat(const FrameCharacter& character);

/// Selects `count` of the characters with a coat to be rendered without level of detail; all of them if there
/// are no more than `count`. Returns one value per character: true if it is selected. Sorts the characters
/// with a coat by their distance from `eye` at `frame`, divides the sorted list into `count` equal groups,
/// and selects the middle character of each group. Thus the selection contains near and far characters.
std::vector<bool> full_detail_characters(const std::vector<FrameCharacter>& characters, int64_t count,
                                         const V3f& eye, double frame);

/// Returns the posed cages of one part of a character. If the part is animated and the shutter is open for
/// some time, these are one cage per motion key of the camera, and two cages at frame - 1/2 and frame + 1/2.
/// Otherwise there is one cage.
CharacterPose pose_character(const FrameCharacter& character, size_t part, const Assets& assets,
                             const CameraParams& camera, double frame);

}  // namespace pelage
